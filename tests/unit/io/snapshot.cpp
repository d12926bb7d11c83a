#include "io/snapshot.hpp"

#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "h5_read.hpp"
#include "io/describe.hpp"
#include "mpi_session.hpp"
#include "temporary_directory.hpp"

namespace tread::io
{
namespace
{

using test::world;
namespace fs = std::filesystem;

PointFields two_points()
{
    PointFields points;
    points.position      = {0.1, 0.2, 0.3, 1000.0000000001, 2, 3};
    points.velocity      = {1, 2, 3, 4, 5, 6};
    points.stress        = {1, 2, 3, 4, 5, 6, 10, 20, 30, 40, 50, 60};
    points.plastic_shear = {0.5F, 0.25F};
    points.material      = {0, 1};
    return points;
}

BodyFields one_body() { return {{1, 2, 3}, {1, 0, 0, 0}, {4, 5, 6}, {7, 8, 9}, {0.025}, {2}, {1}}; }

TEST(Snapshot, points_are_vtkhdf_vertices)
{
    const test::TemporaryDirectory directory;
    const std::string              path = directory.path("points.hdf");
    write_points(world(), path, 0.5, two_points());

    EXPECT_EQ(test::read_dataset(path, "/VTKHDF/Points").values, two_points().position);
    EXPECT_EQ(test::read_dataset(path, "/VTKHDF/NumberOfPoints").values, (std::vector<double>{2}));
    EXPECT_EQ(test::read_dataset(path, "/VTKHDF/NumberOfCells").values, (std::vector<double>{2}));
    EXPECT_EQ(test::read_dataset(path, "/VTKHDF/NumberOfConnectivityIds").values, (std::vector<double>{2}));
    EXPECT_EQ(test::read_dataset(path, "/VTKHDF/Connectivity").values, (std::vector<double>{0, 1}));
    EXPECT_EQ(test::read_dataset(path, "/VTKHDF/Offsets").values, (std::vector<double>{0, 1, 2}));
    EXPECT_EQ(test::read_dataset(path, "/VTKHDF/Types").values, (std::vector<double>{1, 1}));
    EXPECT_EQ(test::read_dataset(path, "/VTKHDF/PointData/velocity").shape, (std::vector<hsize_t>{2, 3}));
    EXPECT_EQ(test::read_dataset(path, "/VTKHDF/PointData/stress").units, "Pa");
    EXPECT_EQ(test::read_dataset(path, "/VTKHDF/PointData/rank").values, (std::vector<double>{0, 0}));
}

// Our order: xx yy zz yz xz xy; VTK labels components xx yy zz xy yz xz.
TEST(Snapshot, stress_stands_in_the_order_that_vtk_labels)
{
    const test::TemporaryDirectory directory;
    const std::string              path = directory.path("points.hdf");
    write_points(world(), path, 0.5, two_points());
    EXPECT_EQ(test::read_dataset(path, "/VTKHDF/PointData/stress").values,
              (std::vector<double>{1, 2, 3, 6, 4, 5, 10, 20, 30, 60, 40, 50}));
}

TEST(Snapshot, absent_fields_are_left_out)
{
    const test::TemporaryDirectory directory;
    const std::string              path = directory.path("points.hdf");
    write_points(world(), path, 0.5, two_points());
    EXPECT_TRUE(test::has_object(path, "/VTKHDF/PointData/velocity"));
    EXPECT_FALSE(test::has_object(path, "/VTKHDF/PointData/displacement"));
    EXPECT_FALSE(test::has_object(path, "/VTKHDF/PointData/plastic_rate"));
}

TEST(Snapshot, writer_numbers_files_and_keeps_the_series)
{
    const test::TemporaryDirectory directory;
    SnapshotWriter                 writer(world(), directory.path("snapshots"));
    writer.write(0.0, two_points(), one_body());
    writer.write(0.25, two_points(), {});

    const fs::path snapshots = directory.path("snapshots");
    EXPECT_TRUE(fs::exists(snapshots / "points_0001.hdf"));
    EXPECT_TRUE(fs::exists(snapshots / "bodies_0000.h5"));
    EXPECT_FALSE(fs::exists(snapshots / "bodies_0001.h5"));
    const auto series = nlohmann::json::parse(test::read_text((snapshots / "points.hdf.series").string()));
    ASSERT_EQ(series["files"].size(), 2u);
    EXPECT_EQ(series["files"][1]["name"], "points_0001.hdf");
    EXPECT_EQ(series["files"][1]["time"], 0.25);
    for (const auto& entry : fs::directory_iterator(snapshots)) { EXPECT_NE(entry.path().extension(), ".tmp"); }
}

TEST(Snapshot, scene_without_points_has_no_point_files)
{
    const test::TemporaryDirectory directory;
    SnapshotWriter                 writer(world(), directory.path("snapshots"));
    writer.write(0.0, {}, one_body());
    EXPECT_FALSE(fs::exists(directory.path("snapshots/points_0000.hdf")));
    EXPECT_FALSE(fs::exists(directory.path("snapshots/points.hdf.series")));
    EXPECT_EQ(test::read_dataset(directory.path("snapshots/bodies_0000.h5"), "/orientation").values,
              (std::vector<double>{1, 0, 0, 0}));
    EXPECT_EQ(test::read_dataset(directory.path("snapshots/bodies_0000.h5"), "/material").values,
              (std::vector<double>{1}));
}

TEST(Snapshot, shapes_keep_names_and_triangles)
{
    const test::TemporaryDirectory directory;
    const SnapshotWriter           writer(world(), directory.path("snapshots"));
    const NamedMesh                mesh{"clast", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}};
    writer.write_shapes({mesh, mesh});
    const std::string path = directory.path("snapshots/shapes.h5");
    EXPECT_EQ(test::read_dataset(path, "/1/vertices").values, (std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0}));
    EXPECT_EQ(test::read_dataset(path, "/0/triangles").values, (std::vector<double>{0, 1, 2}));
    EXPECT_NE(describe_file(path).find("/0/  name = clast"), std::string::npos) << describe_file(path);
}

TEST(Snapshot, unwritable_directory_is_an_environment_error)
{
    EXPECT_THROW(SnapshotWriter(world(), "/proc/nowhere/snapshots"), Error);
    EXPECT_THROW(write_points(world(), "/proc/nowhere/points.hdf", 0, two_points()), EnvironmentError);
}

TEST(Describe, names_shape_type_units_and_attributes)
{
    const test::TemporaryDirectory directory;
    const std::string              path = directory.path("points.hdf");
    write_points(world(), path, 0.5, two_points());
    const std::string text = describe_file(path);
    EXPECT_NE(text.find("/  time = 0.5  scene_hash = "), std::string::npos) << text;
    EXPECT_NE(text.find("/VTKHDF/Points  [2, 3] float64  units = m\n"), std::string::npos) << text;
    EXPECT_NE(text.find("Type = UnstructuredGrid"), std::string::npos) << text;
}

TEST(Describe, file_that_is_not_hdf5_is_bad_input)
{
    const test::TemporaryDirectory directory;
    std::ofstream(directory.path("a.txt")) << "text";
    EXPECT_THROW(describe_file(directory.path("a.txt")), InputError);
    EXPECT_THROW(describe_file(directory.path("missing.h5")), InputError);
}

} // namespace
} // namespace tread::io
