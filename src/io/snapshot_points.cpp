#include <array>
#include <numeric>

#include "io/h5.hpp"
#include "io/snapshot.hpp"

namespace tread::io
{

namespace
{

// VTK_VERTEX of vtkCellType.h.
constexpr std::uint8_t vertex_cell = 1;

// Of xx, yy, zz, yz, xz, xy, in the order in which VTK labels six components.
constexpr std::array<std::size_t, 6> vtk_order = {0, 1, 2, 5, 3, 4};

std::vector<float> in_vtk_order(const std::vector<float>& stress)
{
    std::vector<float> reordered(stress.size());
    for (std::size_t row = 0; row < stress.size(); row += 6)
    {
        for (std::size_t c = 0; c < 6; ++c) { reordered[row + c] = stress[row + vtk_order[c]]; }
    }
    return reordered;
}

// Every rank is a partition; its numbers are one entry of each of these data sets.
void write_partition_sizes(const h5::File& file, const Communicator& communicator, std::int64_t count)
{
    const h5::Rows one = h5::rows_of_rank(communicator, 1);
    for (const char* name : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"})
    {
        h5::write(file, std::string("/VTKHDF/") + name, std::vector<std::int64_t>{count}, 1, one);
    }
}

// Point i is the only corner of cell i; numbers start anew in each partition.
void write_cells(const h5::File& file, const Communicator& communicator, const h5::Rows& rows)
{
    std::vector<std::int64_t> numbers(rows.count + 1);
    std::iota(numbers.begin(), numbers.end(), 0);
    h5::write(file, "/VTKHDF/Offsets", numbers, 1, h5::rows_of_rank(communicator, numbers.size()));
    numbers.pop_back();
    h5::write(file, "/VTKHDF/Connectivity", numbers, 1, rows);
    h5::write(file, "/VTKHDF/Types", std::vector<std::uint8_t>(rows.count, vertex_cell), 1, rows);
}

template<class T>
void write_field(const h5::File& file, const Communicator& communicator, const std::string& name,
                 const std::vector<T>& values, int width, const h5::Rows& rows, const std::string& unit)
{
    if (communicator.maximum(static_cast<std::int64_t>(values.size())) == 0) { return; }
    const std::string path = "/VTKHDF/PointData/" + name;
    h5::write(file, path, values, width, rows);
    h5::write_attribute(file, path, "units", unit);
}

void write_point_data(const h5::File& file, const Communicator& communicator, const PointFields& points,
                      const h5::Rows& rows)
{
    h5::create_group(file, "/VTKHDF/PointData");
    write_field(file, communicator, "displacement", points.displacement, 3, rows, "m");
    write_field(file, communicator, "velocity", points.velocity, 3, rows, "m/s");
    write_field(file, communicator, "stress", in_vtk_order(points.stress), 6, rows, "Pa");
    write_field(file, communicator, "plastic_shear", points.plastic_shear, 1, rows, "1");
    write_field(file, communicator, "plastic_rate", points.plastic_rate, 1, rows, "1/s");
    write_field(file, communicator, "material", points.material, 1, rows, "1");
    write_field(file, communicator, "id", points.id, 1, rows, "1");
    write_field(file, communicator, "rank", std::vector<std::int32_t>(rows.count, communicator.rank()), 1, rows, "1");
    if (communicator.maximum(static_cast<std::int64_t>(points.stress.size())) > 0)
    {
        h5::write_attribute(file, "/VTKHDF/PointData/stress", "components", std::string("xx yy zz xy yz xz"));
    }
}

} // namespace

void write_points(const Communicator& communicator, const std::string& path, double time, const PointFields& points,
                  const Provenance& provenance)
{
    const std::size_t count = points.position.size() / 3;
    const h5::Rows    rows  = h5::rows_of_rank(communicator, count);

    h5::File file = h5::File::create(path, communicator);
    h5::create_group(file, "/VTKHDF");
    h5::write_attribute(file, "/VTKHDF", "Version", std::vector<std::int64_t>{1, 0});
    h5::write_fixed_attribute(file, "/VTKHDF", "Type", "UnstructuredGrid");
    h5::write_attribute(file, "/", "time", time);
    write_provenance(file, provenance, communicator.broadcast(utc_now())); // all ranks must write the same

    write_partition_sizes(file, communicator, static_cast<std::int64_t>(count));
    h5::write(file, "/VTKHDF/Points", points.position, 3, rows);
    h5::write_attribute(file, "/VTKHDF/Points", "units", std::string("m"));
    write_cells(file, communicator, rows);
    write_point_data(file, communicator, points, rows);
    file.close();
}

} // namespace tread::io
