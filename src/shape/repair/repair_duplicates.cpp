#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "shape/mesh/half_edges.hpp"
#include "shape/repair/repair_steps.hpp"

namespace tread::shape
{
namespace
{

/// Groups of coincident triangles: the first of each represents all.
struct Groups
{
    std::vector<std::size_t> first;   ///< triangles, in the order of the mesh
    std::vector<std::size_t> members; ///< number of triangles in each group
};

Groups group_equal(const TriangleMesh& mesh)
{
    std::vector<std::array<std::int32_t, 3>> keys = mesh.triangles;
    for (auto& key : keys) { std::sort(key.begin(), key.end()); }
    std::vector<std::size_t> order(keys.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return keys[a] != keys[b] ? keys[a] < keys[b] : a < b; });

    std::vector<std::size_t> members(keys.size(), 0);
    for (std::size_t i = 0; i < order.size();)
    {
        const std::size_t first = order[i];
        for (; i < order.size() && keys[order[i]] == keys[first]; ++i) { ++members[first]; }
    }
    Groups groups;
    for (std::size_t t = 0; t < members.size(); ++t)
    {
        if (members[t] == 0) { continue; }
        groups.first.push_back(t);
        groups.members.push_back(members[t]);
    }
    return groups;
}

/// Connected sets, along edges, of groups with an even number of members.
class Patches
{
public:
    explicit Patches(std::size_t count)
        : parent_(count)
        , walls_(count, 0)
        , faces_(count, 0)
    {
        std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    }

    std::size_t root(std::size_t at)
    {
        while (parent_[at] != at) { at = parent_[at] = parent_[parent_[at]]; }
        return at;
    }

    void join(std::size_t a, std::size_t b)
    {
        const std::size_t from = root(a), to = root(b);
        if (from == to) { return; }
        parent_[from] = to;
        walls_[to] += walls_[from];
        faces_[to] += faces_[from];
    }

    /// Counts an edge of the rim, at which `others` single triangles meet the patch.
    void add_rim(std::size_t at, std::size_t others)
    {
        if (others == 0) { return; }
        ++(others % 2 == 0 ? walls_ : faces_)[root(at)];
    }

    /// Whether there is surface on both sides: without the patch, its rim is closed.
    bool is_wall(std::size_t at) { return walls_[root(at)] > faces_[root(at)]; }

private:
    std::vector<std::size_t> parent_;
    std::vector<std::size_t> walls_; ///< edges of the rim with an even number of single triangles
    std::vector<std::size_t> faces_; ///< with an odd number
};

Patches find_patches(const TriangleMesh& singles, const std::vector<std::size_t>& members)
{
    const auto is_even = [&](const HalfEdge& half)
    { return members[static_cast<std::size_t>(half.triangle)] % 2 == 0; };
    const std::vector<HalfEdge> half_edges = sorted_half_edges(singles);
    Patches                     patches(members.size());
    for_each_edge(half_edges,
                  [&](auto first, auto last)
                  {
                      const auto one = std::find_if(first, last, is_even);
                      for (auto half = one; half != last; ++half)
                      {
                          if (is_even(*half))
                          {
                              patches.join(static_cast<std::size_t>(one->triangle),
                                           static_cast<std::size_t>(half->triangle));
                          }
                      }
                  });
    for_each_edge(half_edges,
                  [&](auto first, auto last)
                  {
                      const auto others = static_cast<std::size_t>(last - first - std::count_if(first, last, is_even));
                      for (auto half = first; half != last; ++half)
                      {
                          if (is_even(*half)) { patches.add_rim(static_cast<std::size_t>(half->triangle), others); }
                      }
                  });
    return patches;
}

} // namespace

void drop_duplicates(TriangleMesh& mesh, RepairReport& report)
{
    const Groups groups = group_equal(mesh);
    if (groups.first.size() == mesh.triangles.size()) { return; }

    TriangleMesh singles{mesh.vertices, {}};
    for (const std::size_t first : groups.first) { singles.triangles.push_back(mesh.triangles[first]); }
    Patches patches = find_patches(singles, groups.members);
    mesh.triangles.clear();
    for (std::size_t g = 0; g < groups.first.size(); ++g)
    {
        if (groups.members[g] % 2 == 0 && patches.is_wall(g))
        {
            report.dropped_walls += static_cast<std::int64_t>(groups.members[g]);
            continue;
        }
        report.dropped_duplicates += static_cast<std::int64_t>(groups.members[g]) - 1;
        mesh.triangles.push_back(singles.triangles[g]);
    }
}

} // namespace tread::shape
