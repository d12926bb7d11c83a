#include "solver/sand.hpp"

// What others see of the points, those that sleep included.
namespace tread::solver
{
namespace
{

/// The living points' planes of one field as rows on the host.
template<class Out, class Exec, class Real, class T>
std::vector<Out> interleaved(const Array<Exec, T>& field, const mpm::Points<Exec, Real>& points, int components)
{
    const std::vector<T> planes = field.to_host();
    const auto           n = static_cast<std::size_t>(points.count), stride = static_cast<std::size_t>(points.stride),
               width = static_cast<std::size_t>(components);
    std::vector<Out> rows(n * width);
    for (std::size_t i = 0; i < n; ++i)
    {
        for (std::size_t c = 0; c < width; ++c) { rows[i * width + c] = static_cast<Out>(planes[c * stride + i]); }
    }
    return rows;
}

template<class Exec, class Real>
io::PointFields fields_of(const mpm::Points<Exec, Real>& points)
{
    io::PointFields fields;
    fields.position                 = interleaved<double>(points.position, points, 3);
    const std::vector<double> start = interleaved<double>(points.start, points, 3);
    fields.displacement.resize(start.size());
    for (std::size_t i = 0; i < start.size(); ++i)
    {
        fields.displacement[i] = static_cast<float>(fields.position[i] - start[i]);
    }
    fields.velocity                = interleaved<float>(points.velocity, points, 3);
    fields.stress                  = interleaved<float>(points.stress, points, 6);
    const std::vector<float> ratio = interleaved<float>(points.volume_ratio, points, 1);
    for (std::size_t i = 0; i < fields.stress.size(); ++i) { fields.stress[i] /= ratio[i / 6]; } // Kirchhoff to Cauchy
    if (points.plastic_shear.size() > 0)
    {
        fields.plastic_shear = interleaved<float>(points.plastic_shear, points, 1);
        fields.plastic_rate  = interleaved<float>(points.plastic_rate, points, 1);
    }
    fields.material = interleaved<std::int32_t>(points.material, points, 1);
    fields.id       = interleaved<std::uint32_t>(points.id, points, 1);
    return fields;
}

template<class T>
void append(std::vector<T>& to, const std::vector<T>& more)
{
    to.insert(to.end(), more.begin(), more.end());
}

void append(io::PointFields& to, const io::PointFields& more)
{
    append(to.position, more.position);
    append(to.displacement, more.displacement);
    append(to.velocity, more.velocity);
    append(to.stress, more.stress);
    append(to.plastic_shear, more.plastic_shear);
    append(to.plastic_rate, more.plastic_rate);
    append(to.material, more.material);
    append(to.id, more.id);
}

} // namespace

template<class Exec, class Real>
std::vector<Vec3<double>> Sand<Exec, Real>::positions() const
{
    std::vector<double> rows = interleaved<double>(points_.position, points_, 3);
    if (sleep_) { append(rows, interleaved<double>(sleep_->points().position, sleep_->points(), 3)); }
    std::vector<Vec3<double>> out;
    for (std::size_t i = 0; i < rows.size(); i += 3) { out.emplace_back(rows[i], rows[i + 1], rows[i + 2]); }
    return out;
}

template<class Exec, class Real>
io::PointFields Sand<Exec, Real>::fields() const
{
    io::PointFields fields = fields_of(points_);
    if (sleep_) { append(fields, fields_of(sleep_->points())); }
    return fields;
}

template std::vector<Vec3<double>> Sand<Cpu, float>::positions() const;
template io::PointFields           Sand<Cpu, float>::fields() const;
template std::vector<Vec3<double>> Sand<Cpu, double>::positions() const;
template io::PointFields           Sand<Cpu, double>::fields() const;
#ifdef TREAD_WITH_CUDA
template std::vector<Vec3<double>> Sand<Gpu, float>::positions() const;
template io::PointFields           Sand<Gpu, float>::fields() const;
template std::vector<Vec3<double>> Sand<Gpu, double>::positions() const;
template io::PointFields           Sand<Gpu, double>::fields() const;
#endif

} // namespace tread::solver
