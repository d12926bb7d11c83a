#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shape/solids/mass_properties.hpp"
#include "unit/shape/meshes.hpp"

namespace tread::shape
{
namespace
{

using ::testing::AllOf;
using ::testing::HasSubstr;

/// A temporary folder, removed with its files.
class MeshFiles : public ::testing::Test
{
protected:
    MeshFiles() { std::filesystem::create_directories(folder_); }
    ~MeshFiles() override { std::filesystem::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    std::string write(const std::string& name, const std::string& bytes) const
    {
        std::ofstream(path(name), std::ios::binary) << bytes;
        return path(name);
    }

    std::string binary_cube() const
    {
        write_stl(test::cube(2), path("whole.stl"));
        std::ifstream file(path("whole.stl"), std::ios::binary);
        return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    }

    std::string complaint(const std::string& name, const std::string& bytes) const
    {
        const std::string file    = write(name, bytes);
        const std::string message = test::input_error([&] { read_mesh(file, 1); });
        EXPECT_THAT(message, HasSubstr(name));
        return message;
    }

private:
    std::filesystem::path folder_ =
        std::filesystem::path(::testing::TempDir()) / ::testing::UnitTest::GetInstance()->current_test_info()->name();
};

void expect_cube(const TriangleMesh& mesh, double edge)
{
    EXPECT_EQ(mesh.vertices.size(), 8u);
    EXPECT_EQ(mesh.triangles.size(), 12u);
    EXPECT_NO_THROW(require_watertight(mesh, "cube"));
    EXPECT_NEAR(mass_properties(mesh).volume, edge * edge * edge, 1e-12);
}

std::string text_stl(const TriangleMesh& mesh)
{
    std::string text = "solid cube\n";
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        text += " facet normal 0 0 0\r\n  outer loop\n";
        for (std::size_t c = 0; c < 3; ++c)
        {
            const Eigen::Vector3d& v = corner(mesh, t, c);
            text += "   vertex " + std::to_string(v.x()) + "\t+" + std::to_string(v.y() + 9) + " " +
                    std::to_string(v.z()) + "e0\n";
        }
        text += "  endloop\n endfacet\n";
    }
    return text + "endsolid cube\n";
}

const std::string obj_vertices = "# a cube\nv -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\n"
                                 "v -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\nvn 0 0 1\nvt 0 0\n";

TEST_F(MeshFiles, BinaryStlRoundTrip)
{
    const TriangleMesh mesh = rock_mesh({5, 0.7, 0.9, 162}, "rock");
    write_stl(mesh, path("rock.stl"));
    const TriangleMesh read = read_mesh(path("rock.stl"), 1);
    ASSERT_EQ(read.triangles.size(), mesh.triangles.size());
    EXPECT_EQ(read.vertices.size(), mesh.vertices.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
        for (std::size_t c = 0; c < 3; ++c)
        {
            EXPECT_EQ(corner(read, t, c).cast<float>(), corner(mesh, t, c).cast<float>());
        }
    }
}

TEST_F(MeshFiles, BinaryStlMayBeginWithSolid)
{
    std::string bytes = binary_cube();
    std::memcpy(bytes.data(), "solid by a sloppy program", 25);
    expect_cube(read_mesh(write("sloppy.stl", bytes), 1), 2);
}

TEST_F(MeshFiles, TextStl) { expect_cube(read_mesh(write("cube.STL", text_stl(test::cube(2))), 1), 2); }

TEST_F(MeshFiles, UnitScalesTheMesh) { expect_cube(read_mesh(write("mm.stl", binary_cube()), 1e-3), 2e-3); }

TEST_F(MeshFiles, ObjWithPolygonsNegativeAndSlashedIndices)
{
    const std::string faces =
        "g sides\nusemtl none\nf 1/1/1 3/1/1 4/1/1 2/1/1\nf 5//1 6//1 8//1 7//1\nf 1/1 2/1 6/1 5/1\n"
        "f -6 -2 -1 -5 # comment\nf 1 5 7 3\nf 2 4 8 6\n";
    expect_cube(read_mesh(write("cube.obj", obj_vertices + faces), 1), 2);
}

TEST_F(MeshFiles, BadBinaryStl)
{
    const std::string good = binary_cube();
    EXPECT_THAT(complaint("cut.stl", good.substr(0, good.size() - 7)),
                AllOf(HasSubstr("promises 12 triangles"), HasSubstr("684 bytes"), HasSubstr("677")));
    EXPECT_THAT(complaint("long.stl", good + "x"), HasSubstr("685"));
    EXPECT_THAT(complaint("short.stl", "abc"), HasSubstr("too few"));
    EXPECT_THAT(complaint("empty.stl", ""), HasSubstr("empty"));

    std::string none = good.substr(0, 84);
    std::memset(none.data() + 80, 0, 4);
    EXPECT_THAT(complaint("none.stl", none), HasSubstr("no triangles"));

    std::string huge = good;
    std::memset(huge.data() + 80, 0xff, 4);
    EXPECT_THAT(complaint("huge.stl", huge), HasSubstr("promises 4294967295 triangles"));

    std::string swapped = good;
    std::swap(swapped[80], swapped[83]);
    std::swap(swapped[81], swapped[82]);
    EXPECT_THAT(complaint("swapped.stl", swapped), HasSubstr("big-endian"));
}

TEST_F(MeshFiles, BinaryStlWithoutFiniteCoordinates)
{
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
    {
        std::string bytes = binary_cube();
        std::memcpy(bytes.data() + 84 + 50 * 3 + 12 + 8, &bad, 4);
        EXPECT_THAT(complaint("bad.stl", bytes), AllOf(HasSubstr("triangle 3"), HasSubstr("not finite")));
    }
}

TEST_F(MeshFiles, BadTextStl)
{
    const std::string good = text_stl(test::cube(2));
    EXPECT_THAT(complaint("cut.stl", good.substr(0, good.rfind("   vertex"))), HasSubstr("truncated"));
    EXPECT_THAT(complaint("noend.stl", good.substr(0, good.rfind("endsolid"))), HasSubstr("truncated"));
    EXPECT_THAT(complaint("two.stl", "solid a\nfacet\nvertex 0 0 0\nvertex 1 0 0\nendfacet\nendsolid\n"),
                AllOf(HasSubstr("two.stl:5:"), HasSubstr("2 vertices")));
    EXPECT_THAT(complaint("word.stl", "solid a\nfacet\nvertex 0 zero 0\n"),
                AllOf(HasSubstr("word.stl:3:"), HasSubstr("'zero'")));
    EXPECT_THAT(complaint("nan.stl", "solid a\nfacet\nvertex 0 nan 0\n"),
                AllOf(HasSubstr("nan.stl:3:"), HasSubstr("not finite")));
    EXPECT_THAT(complaint("few.stl", "solid a\nfacet\nvertex 0 1\n"), HasSubstr("few.stl:3:"));
    EXPECT_THAT(complaint("poem.stl", "solid a\nroses are red\n"), AllOf(HasSubstr("poem.stl:2:"), HasSubstr("roses")));
    EXPECT_THAT(complaint("none.stl", "solid a\nendsolid a\n"), HasSubstr("no triangles"));
}

TEST_F(MeshFiles, BadObj)
{
    EXPECT_THAT(complaint("zero.obj", obj_vertices + "f 0 1 2\n"),
                AllOf(HasSubstr("zero.obj:12:"), HasSubstr("range")));
    EXPECT_THAT(complaint("high.obj", obj_vertices + "f 1 2 9\n"), AllOf(HasSubstr("high.obj:12:"), HasSubstr("9")));
    EXPECT_THAT(complaint("low.obj", obj_vertices + "f 1 2 -9\n"), HasSubstr("low.obj:12:"));
    EXPECT_THAT(complaint("huge.obj", obj_vertices + "f 1 2 99999999999999999999\n"), HasSubstr("huge.obj:12:"));
    EXPECT_THAT(complaint("word.obj", obj_vertices + "f 1 2 x\n"), HasSubstr("'x'"));
    EXPECT_THAT(complaint("two.obj", obj_vertices + "f 1 2\n"), HasSubstr("2 vertices"));
    EXPECT_THAT(complaint("inf.obj", "v 0 0 inf\n"), AllOf(HasSubstr("inf.obj:1:"), HasSubstr("not finite")));
    EXPECT_THAT(complaint("none.obj", obj_vertices), HasSubstr("no triangles"));
}

TEST_F(MeshFiles, CoordinatesBeyondReason)
{
    EXPECT_THAT(complaint("far.obj", "v 0 0 0\nv 1e200 0 0\nv 0 1 0\nf 1 2 3\n"),
                AllOf(HasSubstr("1e+200 m"), HasSubstr("unit")));
}

TEST_F(MeshFiles, FilesThatAreNone)
{
    EXPECT_THAT(complaint("cube.ply", "ply\n"), HasSubstr(".stl and .obj"));
    EXPECT_THAT(test::input_error([&] { read_mesh(path("missing.stl"), 1); }), HasSubstr("missing.stl"));
    std::filesystem::create_directory(path("folder.stl"));
    EXPECT_THAT(test::input_error([&] { read_mesh(path("folder.stl"), 1); }), HasSubstr("folder.stl"));
}

} // namespace
} // namespace tread::shape
