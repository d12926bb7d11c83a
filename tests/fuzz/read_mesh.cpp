#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "base/errors.hpp"
#include "shape/mesh/mesh_reader.hpp"
#include "shape/repair/repair.hpp"
#include "shape/solids/solid.hpp"

// Feeds arbitrary bytes as a mesh file: the result must be an InputError or a mesh. The first byte selects the format.
namespace
{

using namespace tread;
using namespace tread::shape;

TriangleMesh read(std::uint8_t format, std::string_view bytes)
{
    return weld(format % 2 == 0 ? read_stl(bytes, "fuzz.stl") : read_obj(bytes, "fuzz.obj"));
}

/// Guarantee of repair for any mesh: indices in range.
void require_repaired(const TriangleMesh& mesh)
{
    const Repaired repaired = repair_mesh(mesh);
    for (const auto& triangle : repaired.mesh.triangles)
    {
        for (const std::int32_t vertex : triangle)
        {
            if (vertex < 0 || static_cast<std::size_t>(vertex) >= repaired.mesh.vertices.size()) { std::abort(); }
        }
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    // The sign of a mesh is sampled ten thousand times: only for small meshes, and not for each of them.
    constexpr std::size_t few = 12, each = 16;

    if (size == 0) { return 0; }
    try
    {
        const TriangleMesh mesh = read(data[0], {reinterpret_cast<const char*>(data) + 1, size - 1});
        if (mesh.triangles.empty()) { return 0; }
        require_sane_size(mesh, "fuzz");
        require_repaired(mesh);
        describe_defects(mesh);
        if (mesh.triangles.size() <= few && size % each == 0) { make_solid(mesh, Repair::none, "fuzz"); }
    }
    catch (const InputError&)
    {
    }
    return 0;
}
