#include "io/sdf_report.hpp"

#include "io/h5.hpp"

namespace tread::io
{
namespace
{

template<class M>
void write_column(const h5::File& file, const std::string& name, const std::string& unit,
                  const std::vector<shape::SdfQuality>& qualities, M shape::SdfQuality::*member)
{
    std::vector<double> column;
    column.reserve(qualities.size());
    for (const shape::SdfQuality& quality : qualities) { column.push_back(static_cast<double>(quality.*member)); }
    h5::write(file, name, column, 1);
    h5::write_attribute(file, name, "units", unit);
}

} // namespace

void write_sdf_report(const std::string& path, const shape::ShapeTemplate& form,
                      const std::vector<shape::SdfQuality>& qualities)
{
    using shape::SdfQuality;
    auto file = h5::File::create(path);
    h5::write_attribute(file, "/", "shape", form.name);
    h5::write_attribute(file, "/", "extent", form.box.extent().maxCoeff());
    write_column(file, "cells", "1", qualities, &SdfQuality::cells);
    write_column(file, "mean_surface", "extent", qualities, &SdfQuality::mean_surface);
    write_column(file, "worst_surface", "extent", qualities, &SdfQuality::worst_surface);
    write_column(file, "volume_ratio", "1", qualities, &SdfQuality::volume_ratio);
    write_column(file, "mean_normal", "degree", qualities, &SdfQuality::mean_normal);
    write_column(file, "worst_normal", "degree", qualities, &SdfQuality::worst_normal);
    write_column(file, "seconds", "s", qualities, &SdfQuality::seconds);
    write_column(file, "bytes", "B", qualities, &SdfQuality::bytes);
    file.close();
}

} // namespace tread::io
