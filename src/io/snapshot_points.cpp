#include <array>
#include <numeric>

#include "io/shared_file.hpp"
#include "io/snapshot.hpp"

namespace tread::io
{

namespace
{

// VTK_VERTEX of vtkCellType.h.
constexpr std::uint8_t vertex_cell = 1;

// Permutation of xx, yy, zz, yz, xz, xy to the order in which VTK labels six components.
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

std::string in_file(const std::string& name) { return "/VTKHDF/" + name; }
std::string in_data(const std::string& name) { return in_file("PointData/" + name); }

/// Writes nothing if no rank has values.
template<class T>
void write_field(const Communicator& communicator, SharedFile& file, const std::string& name,
                 const std::vector<T>& values, int width, const std::string& unit)
{
    if (communicator.maximum(static_cast<std::int64_t>(values.size())) == 0) { return; }
    file.write_with_unit(in_data(name), values, width, unit);
}

// Every rank is a partition; its sizes are one entry of each of these data sets.
void write_partition_sizes(SharedFile& file, std::int64_t count)
{
    for (const char* name : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"})
    {
        file.write(in_file(name), std::vector<std::int64_t>{count}, 1);
    }
}

// Point i is the only corner of cell i; numbering restarts in each partition.
void write_cells(SharedFile& file, std::size_t count)
{
    std::vector<std::int64_t> numbers(count + 1);
    std::iota(numbers.begin(), numbers.end(), 0);
    file.write(in_file("Offsets"), numbers, 1);
    numbers.pop_back();
    file.write(in_file("Connectivity"), numbers, 1);
    file.write(in_file("Types"), std::vector<std::uint8_t>(count, vertex_cell), 1);
}

void write_point_data(const Communicator& communicator, SharedFile& file, const PointFields& points)
{
    file.together([](const h5::File& h5) { h5::create_group(h5, in_file("PointData")); });
    const auto field = [&](const std::string& name, const auto& values, int width, const std::string& unit)
    { write_field(communicator, file, name, values, width, unit); };
    field("displacement", points.displacement, 3, "m");
    field("velocity", points.velocity, 3, "m/s");
    field("stress", in_vtk_order(points.stress), 6, "Pa");
    field("plastic_shear", points.plastic_shear, 1, "1");
    field("plastic_rate", points.plastic_rate, 1, "1/s");
    field("material", points.material, 1, "1");
    field("id", points.id, 1, "1");
    field("rank", std::vector<std::int32_t>(points.position.size() / 3, communicator.rank()), 1, "1");
    file.together(
        [](const h5::File& h5)
        {
            const std::string stress = in_data("stress");
            if (!h5::holds(h5, stress)) { return; }
            h5::write_attribute(h5, stress, "components", std::string("xx yy zz xy yz xz"));
        });
}

} // namespace

void write_points(const Communicator& communicator, const std::string& path, double time, const PointFields& points,
                  const Provenance& provenance)
{
    const std::size_t count   = points.position.size() / 3;
    const std::string written = communicator.broadcast(utc_now()); // all ranks must write the same
    SharedFile        file(communicator, path);
    file.together(
        [&](const h5::File& h5)
        {
            h5::create_group(h5, "/VTKHDF");
            h5::write_attribute(h5, "/VTKHDF", "Version", std::vector<std::int64_t>{1, 0});
            h5::write_fixed_attribute(h5, "/VTKHDF", "Type", "UnstructuredGrid");
            h5::write_attribute(h5, "/", "time", time);
            write_provenance(h5, provenance, written);
        });
    write_partition_sizes(file, static_cast<std::int64_t>(count));
    file.write_with_unit(in_file("Points"), points.position, 3, "m");
    write_cells(file, count);
    write_point_data(communicator, file, points);
    file.close();
}

} // namespace tread::io
