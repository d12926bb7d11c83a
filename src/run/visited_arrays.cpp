#include "run/visited_arrays.hpp"

#include <type_traits>

#include <fmt/format.h>

#include "backend/backends.hpp"
#include "backend/instantiate.hpp"
#include "base/errors.hpp"

namespace tread::run
{
namespace
{

template<class T>
constexpr NumberKind kind_of()
{
    if (std::is_floating_point_v<T>) { return NumberKind::floating; }
    return std::is_signed_v<T> ? NumberKind::integer : NumberKind::natural;
}

/// Numbers in a value of an array.
template<class T>
struct Parts
{
    using Number                          = T;
    static constexpr std::int64_t columns = 1;
};

template<>
struct Parts<Vec3<double>>
{
    using Number                          = double;
    static constexpr std::int64_t columns = 3;
};

template<>
struct Parts<Quat>
{
    using Number                          = double;
    static constexpr std::int64_t columns = 4;
};

} // namespace

template<class Exec, class Real>
VisitedArrays<Exec, Real>::VisitedArrays(solver::Simulation<Exec, Real>& simulation, const solver::Plan& plan,
                                         bool moved)
    : simulation_(simulation)
    , plan_(plan)
    , moved_(moved)
{
}

template<class Exec, class Real>
std::byte* VisitedArrays<Exec, Real>::room(std::size_t bytes)
{
    return copies_.emplace_back(bytes).data();
}

/// A field of the points, which is stored as planes of `components`.
template<class Exec, class Real>
template<class T>
HostArray VisitedArrays<Exec, Real>::planes(Array<Exec, T> Points::*member, std::int64_t components)
{
    const std::vector<const Points*> parts = simulation_.sand().all_points();
    std::int64_t                     count = 0;
    for (const Points* part : parts) { count += part->count; }
    constexpr auto size = static_cast<std::int64_t>(sizeof(T));
    HostArray      array{nullptr, kind_of<T>(), sizeof(T), count, components, size, size * count};
    if (!is_gpu<Exec> && parts.size() == 1)
    {
        array.data        = (parts[0]->*member).data();
        array.column_step = size * parts[0]->stride;
        return array;
    }
    std::byte* const to    = room(static_cast<std::size_t>(size * count * components));
    std::int64_t     first = 0;
    for (const Points* part : parts)
    {
        for (std::int64_t c = 0; c < components; ++c)
        {
            copy_to_host((part->*member).exec(), to + size * (c * count + first),
                         (part->*member).data() + c * part->stride, static_cast<std::size_t>(size * part->count));
        }
        first += part->count;
    }
    array.data = to;
    return array;
}

/// An array of the bodies or of their pairs.
template<class Exec, class Real>
template<class T>
HostArray VisitedArrays<Exec, Real>::rows(const Array<Exec, T>& array)
{
    using Number       = typename Parts<T>::Number;
    const void* data   = array.data();
    const auto  in_all = static_cast<std::size_t>(array.size()) * sizeof(T);
    if (is_gpu<Exec>)
    {
        std::byte* const to = room(in_all);
        copy_to_host(array.exec(), to, array.data(), in_all);
        data = to;
    }
    return {data, kind_of<Number>(), sizeof(Number), array.size(), Parts<T>::columns, sizeof(T), sizeof(Number)};
}

template<class Exec, class Real>
std::optional<HostArray> VisitedArrays<Exec, Real>::find(const std::string& name)
{
    const std::string        table = name.substr(0, name.find('.')), field = name.substr(table.size());
    std::optional<HostArray> found;
    if (table == "points") { found = point_field(field); }
    if (table == "bodies") { found = body_field(field); }
    if (table == "contacts") { found = contact_field(field); }
    if (!found) { throw InputError(fmt::format("no run has a field '{}'", name)); }
    return found->bytes == 0 ? std::nullopt : found;
}

template<class Exec, class Real>
std::optional<HostArray> VisitedArrays<Exec, Real>::point_field(const std::string& name)
{
    std::optional<HostArray> found;
    const auto               offer = [&](const char* known, auto member, std::int64_t components)
    {
        if (name != known) { return; }
        found              = HostArray{};
        const bool is_kept = plan_.sand && (simulation_.sand().points().*member).size() > 0;
        if (is_kept) { found = planes(member, components); }
    };
    offer(".position", &Points::position, 3);
    offer(".start", &Points::start, 3);
    offer(".velocity", &Points::velocity, 3);
    offer(".kirchhoff_stress", &Points::stress, 6);
    offer(".mass", &Points::mass, 1);
    offer(".initial_volume", &Points::volume, 1);
    offer(".volume_ratio", &Points::volume_ratio, 1);
    offer(".id", &Points::id, 1);
    offer(".material", &Points::material, 1);
    offer(".plastic_shear", &Points::plastic_shear, 1);
    offer(".plastic_rate", &Points::plastic_rate, 1);
    return found;
}

template<class Exec, class Real>
std::optional<HostArray> VisitedArrays<Exec, Real>::body_field(const std::string& name)
{
    using Bodies = dem::Bodies<Exec>;
    std::optional<HostArray> found;
    const auto               offer = [&](const char* known, auto member)
    {
        if (name != known) { return; }
        found = HostArray{};
        if (plan_.bodies) { found = rows(simulation_.rigid().bodies().*member); }
    };
    offer(".position", &Bodies::position);
    offer(".orientation", &Bodies::orientation);
    offer(".velocity", &Bodies::velocity);
    offer(".angular_velocity", &Bodies::angular_velocity);
    offer(".mass", &Bodies::mass);
    offer(".scale", &Bodies::scale);
    offer(".shape", &Bodies::shape);
    offer(".force", &Bodies::force);
    offer(".torque", &Bodies::torque);
    return found;
}

template<class Exec, class Real>
std::optional<HostArray> VisitedArrays<Exec, Real>::contact_field(const std::string& name)
{
    std::optional<HostArray> found;
    const auto               offer = [&](const char* known, const auto& array_of)
    {
        if (name != known) { return; }
        found = HostArray{};
        if (!plan_.body_contact) { return; }
        found = rows(array_of(simulation_.rigid().pairs()));
        if (!moved_) { found->rows = 0; }
    };
    offer(
        ".key", [](const auto& pairs) -> const auto& { return pairs.key; });
    offer(
        ".force", [](const auto& pairs) -> const auto& { return pairs.answers.force; });
    offer(
        ".torque", [](const auto& pairs) -> const auto& { return pairs.answers.torque; });
    offer(
        ".stiffness", [](const auto& pairs) -> const auto& { return pairs.answers.stiffness; });
    offer(
        ".energy", [](const auto& pairs) -> const auto& { return pairs.answers.energy; });
    return found;
}

#define TREAD_INSTANTIATE(Exec, Real) template class VisitedArrays<Exec, Real>
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::run
