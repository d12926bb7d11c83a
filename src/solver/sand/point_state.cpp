#include "solver/sand/point_state.hpp"

#include <string_view>

#include <fmt/format.h>

#include "backend/instantiate.hpp"

namespace tread::solver
{
namespace
{

/// Whether a field of the points never changes. Such fields are rebuilt, not saved: 33 bytes a point.
bool lasts(std::string_view name)
{
    return name == "start" || name == "mass" || name == "volume" || name == "material";
}

/// Spacings beyond the domain at which a point that has not been removed yet may be.
constexpr double outside = 16;

/// Accepts point ids that have not been seen before; marks them as seen.
auto new_ids(std::vector<bool>& seen)
{
    return [&seen](const auto& values) -> accept::Verdict
    {
        for (std::size_t i = 0; i < values.size(); ++i)
        {
            const auto id = static_cast<std::size_t>(values[i]);
            if (id < seen.size() && !seen[id])
            {
                seen[id] = true;
                continue;
            }
            return accept::Refusal{static_cast<std::int64_t>(i), fmt::format("{}", values[i]),
                                   fmt::format("each of 0 to {} once at most", seen.size() - 1)};
        }
        return {};
    };
}

/// Accepts valid values of one plane of a point field. Only ids are integers.
auto accepted_plane(std::string_view name, double lowest, double highest, std::vector<bool>& seen)
{
    return [=, &seen]<class T>(const std::vector<T>& values) -> accept::Verdict
    {
        if constexpr (std::is_integral_v<T>) { return new_ids(seen)(values); }
        else
        {
            if (name == "position") { return accept::within(lowest, highest)(values); }
            if (name == "volume_ratio") { return accept::positive()(values); }
            return accept::finite()(values);
        }
    };
}

/// Restores constant fields by id.
template<class Exec, class Real>
void restore_lasting(mpm::Points<Exec, Real>& points, const world::Sand& built)
{
    const std::vector<std::uint32_t> id    = points.id.to_host();
    const auto                       count = static_cast<std::size_t>(points.count);
    std::vector<world::SandPoint>    known;
    known.reserve(count);
    for (std::size_t i = 0; i < count; ++i) { known.push_back(world::point_of(built, id[i])); }
    const auto restore = [&](auto& field, int component, const auto& value)
    {
        std::vector<std::decay_t<decltype(*field.data())>> plane(count);
        for (std::size_t i = 0; i < count; ++i)
        {
            plane[i] = static_cast<std::decay_t<decltype(*field.data())>>(value(known[i]));
        }
        copy_from_host(points.position.exec(), field.data() + component * points.stride, plane.data(),
                       count * sizeof(plane[0]));
    };
    for (int c = 0; c < 3; ++c)
    {
        restore(points.start, c, [c](const world::SandPoint& point) { return point.position[c]; });
    }
    restore(points.mass, 0, [](const world::SandPoint& point) { return point.kind.mass; });
    restore(points.volume, 0, [](const world::SandPoint& point) { return point.kind.volume; });
    restore(points.material, 0, [](const world::SandPoint& point) { return point.kind.material; });
}

} // namespace

template<class Exec, class Real>
void transfer_points(StateFile& file, mpm::Points<Exec, Real>& points, const std::string& folder,
                     const mpm::GridGeometry& geometry, const world::Sand& built, std::vector<bool>& seen)
{
    const double     beyond = outside * geometry.spacing;
    StateFile::Share rows{0, points.count, points.count};
    if (file.loads())
    {
        rows = file.share(fmt::format("{}/id_0", folder), seen.size());
        points.reserve(rows.count);
        points.count = rows.count;
    }
    points.for_each_named_field(
        [&](const char* name, auto& field, int components)
        {
            for (int c = 0; c < components && !lasts(name); ++c)
            {
                const double highest = geometry.size[c % 3] + beyond;
                file.plane(field.exec(), fmt::format("{}/{}_{}", folder, name, c), field.data() + c * points.stride,
                           rows, accepted_plane(name, -beyond, highest, seen));
            }
        });
    if (file.loads()) { restore_lasting(points, built); }
}

#define TREAD_INSTANTIATE(Exec, Real)                                                                                  \
    template void transfer_points(StateFile&, mpm::Points<Exec, Real>&, const std::string&, const mpm::GridGeometry&,  \
                                  const world::Sand&, std::vector<bool>&)
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
