#include <array>
#include <numeric>
#include <optional>

#include "io/h5.hpp"
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

/// A file written by all ranks. A failure on one is a failure on all, so that none waits in the next collective call.
class SharedFile
{
public:
    SharedFile(const Communicator& communicator, const std::string& path)
        : communicator_(communicator)
    {
        on_every_rank(communicator, [&] { file_.emplace(h5::File::create(path, communicator)); });
    }

    /// `work` takes the h5::File.
    template<class Work>
    void together(const Work& work)
    {
        on_every_rank(communicator_, [&] { work(*file_); });
    }

    template<class T>
    void write(const std::string& name, const std::vector<T>& values, int width)
    {
        const h5::Rows rows = h5::rows_of_rank(communicator_, values.size() / static_cast<std::size_t>(width));
        together([&](const h5::File& h5) { h5::write(h5, "/VTKHDF/" + name, values, width, rows); });
    }

    /// Writes nothing if no rank has values.
    template<class T>
    void write_field(const std::string& name, const std::vector<T>& values, int width, const std::string& unit)
    {
        if (communicator_.maximum(static_cast<std::int64_t>(values.size())) == 0) { return; }
        write("PointData/" + name, values, width);
        together([&](const h5::File& h5) { h5::write_attribute(h5, "/VTKHDF/PointData/" + name, "units", unit); });
    }

    void close()
    {
        together([](h5::File& h5) { h5.close(); });
    }

private:
    const Communicator&     communicator_;
    std::optional<h5::File> file_;
};

// Every rank is a partition; its sizes are one entry of each of these data sets.
void write_partition_sizes(SharedFile& file, std::int64_t count)
{
    for (const char* name : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"})
    {
        file.write(name, std::vector<std::int64_t>{count}, 1);
    }
}

// Point i is the only corner of cell i; numbering restarts in each partition.
void write_cells(SharedFile& file, std::size_t count)
{
    std::vector<std::int64_t> numbers(count + 1);
    std::iota(numbers.begin(), numbers.end(), 0);
    file.write("Offsets", numbers, 1);
    numbers.pop_back();
    file.write("Connectivity", numbers, 1);
    file.write("Types", std::vector<std::uint8_t>(count, vertex_cell), 1);
}

void write_point_data(SharedFile& file, const PointFields& points, std::int32_t rank)
{
    file.together([](const h5::File& h5) { h5::create_group(h5, "/VTKHDF/PointData"); });
    file.write_field("displacement", points.displacement, 3, "m");
    file.write_field("velocity", points.velocity, 3, "m/s");
    file.write_field("stress", in_vtk_order(points.stress), 6, "Pa");
    file.write_field("plastic_shear", points.plastic_shear, 1, "1");
    file.write_field("plastic_rate", points.plastic_rate, 1, "1/s");
    file.write_field("material", points.material, 1, "1");
    file.write_field("id", points.id, 1, "1");
    file.write_field("rank", std::vector<std::int32_t>(points.position.size() / 3, rank), 1, "1");
    file.together(
        [](const h5::File& h5)
        {
            const char* stress = "/VTKHDF/PointData/stress";
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
    file.write("Points", points.position, 3);
    file.together([](const h5::File& h5) { h5::write_attribute(h5, "/VTKHDF/Points", "units", std::string("m")); });
    write_cells(file, count);
    write_point_data(file, points, communicator.rank());
    file.close();
}

} // namespace tread::io
