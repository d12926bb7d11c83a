#include "solver/sand/point_copy.hpp"
#include "backend/instantiate.hpp"

namespace tread::solver
{
namespace
{

/// Converts planes of `count` values to rows.
template<class Out, class Host, class T>
std::vector<Out> rows_of(const Array<Host, T>& planes, std::int64_t count, int components)
{
    const auto       n = static_cast<std::size_t>(count), width = static_cast<std::size_t>(components);
    std::vector<Out> rows(planes.size() > 0 ? n * width : 0);
    for (std::size_t c = 0; c < width && !rows.empty(); ++c)
    {
        const T* plane = planes.data() + c * n;
        for (std::size_t i = 0; i < n; ++i) { rows[i * width + c] = static_cast<Out>(plane[i]); }
    }
    return rows;
}

} // namespace

template<class Exec, class Real>
PointCopy<Exec, Real>::PointCopy(const Exec& exec)
    : position_(host_side(exec, host_), "snapshot position")
    , start_(host_side(exec, host_), "snapshot start")
    , velocity_(host_side(exec, host_), "snapshot velocity")
    , stress_(host_side(exec, host_), "snapshot stress")
    , volume_ratio_(host_side(exec, host_), "snapshot volume ratio")
    , plastic_shear_(host_side(exec, host_), "snapshot plastic shear")
    , plastic_rate_(host_side(exec, host_), "snapshot plastic rate")
    , id_(host_side(exec, host_), "snapshot id")
    , material_(host_side(exec, host_), "snapshot material")
{
}

template<class Exec, class Real>
template<class T>
void PointCopy<Exec, Real>::fetch(const Exec& exec, Array<Host, T>& to, const Array<Exec, T>& from, int components,
                                  const Part& part)
{
    if (from.size() == 0) { return; }
    to.resize(components * count_);
    for (int c = 0; c < components; ++c)
    {
        start_copy_to_host(exec, to.data() + c * count_ + part.first, from.data() + c * part.stride,
                           static_cast<std::size_t>(part.count) * sizeof(T));
    }
}

template<class Exec, class Real>
void PointCopy<Exec, Real>::take(const Exec& exec, const std::vector<const mpm::Points<Exec, Real>*>& parts)
{
    count_ = 0;
    for (const auto* points : parts) { count_ += points->count; }
    std::int64_t first = 0;
    for (const auto* points : parts)
    {
        const Part part{first, points->count, points->stride};
        fetch(exec, position_, points->position, 3, part);
        fetch(exec, start_, points->start, 3, part);
        fetch(exec, velocity_, points->velocity, 3, part);
        fetch(exec, stress_, points->stress, 6, part);
        fetch(exec, volume_ratio_, points->volume_ratio, 1, part);
        fetch(exec, plastic_shear_, points->plastic_shear, 1, part);
        fetch(exec, plastic_rate_, points->plastic_rate, 1, part);
        fetch(exec, id_, points->id, 1, part);
        fetch(exec, material_, points->material, 1, part);
        first += points->count;
    }
    synchronize(exec);
}

template<class Exec, class Real>
io::PointFields PointCopy<Exec, Real>::rows() const
{
    io::PointFields fields;
    fields.position                 = rows_of<double>(position_, count_, 3);
    const std::vector<double> start = rows_of<double>(start_, count_, 3);
    fields.displacement.resize(start.size());
    for (std::size_t i = 0; i < start.size(); ++i)
    {
        fields.displacement[i] = static_cast<float>(fields.position[i] - start[i]);
    }
    fields.velocity                = rows_of<float>(velocity_, count_, 3);
    fields.stress                  = rows_of<float>(stress_, count_, 6);
    const std::vector<float> ratio = rows_of<float>(volume_ratio_, count_, 1);
    for (std::size_t i = 0; i < fields.stress.size(); ++i) { fields.stress[i] /= ratio[i / 6]; } // Kirchhoff to Cauchy
    fields.plastic_shear = rows_of<float>(plastic_shear_, count_, 1);
    fields.plastic_rate  = rows_of<float>(plastic_rate_, count_, 1);
    fields.material      = rows_of<std::int32_t>(material_, count_, 1);
    fields.id            = rows_of<std::uint32_t>(id_, count_, 1);
    fields.volume_ratio  = ratio;
    return fields;
}

#define TREAD_INSTANTIATE(Exec, Real) template class PointCopy<Exec, Real>
TREAD_FOR_BACKENDS_AND_REALS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
