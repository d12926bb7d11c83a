#include "shape/generators/rock_body.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include <Eigen/Geometry>

#include "base/random.hpp"
#include "shape/mesh/triangle.hpp"

namespace tread::shape
{
namespace
{

/// Random direction, uniform on the unit sphere.
Eigen::Vector3d direction(Random& random)
{
    const double height = 2 * random.uniform() - 1;
    const double turn   = 2 * std::numbers::pi * random.uniform();
    const double reach  = std::sqrt(1 - height * height);
    return {reach * std::cos(turn), reach * std::sin(turn), height};
}

/// Candidate farthest from its predecessors (Mitchell 1991, Comput. Graph. 25:157), so that planes cover all sides
/// without repetition.
Eigen::Vector3d lonely_direction(Random& random, const std::vector<RockCharacter::Plane>& others)
{
    constexpr int   candidates = 8;
    Eigen::Vector3d best       = direction(random);
    double          least      = 2;
    for (int i = 0; i < candidates; ++i)
    {
        const Eigen::Vector3d candidate = direction(random);
        double                nearest   = -1;
        for (const auto& other : others) { nearest = std::max(nearest, other.normal.dot(candidate)); }
        if (nearest >= least) { continue; }
        least = nearest;
        best  = candidate;
    }
    return best;
}

/// The cuts at one depth. Face 0 is the ball's, faces from 1 are those of planes.
class Cuts
{
public:
    Cuts(const RockCharacter& character, double cut)
    {
        for (const auto& plane : character.planes)
        {
            normals_.push_back(plane.normal);
            distances_.push_back(1 - cut * plane.bite * (1 - plane.tiring * cut));
        }
    }

    struct Face
    {
        std::size_t index;
        double      radius; ///< from the centre to the face in the given direction
    };

    Face face(const Eigen::Vector3d& direction) const
    {
        Face nearest{0, 1};
        for (std::size_t i = 0; i < normals_.size(); ++i)
        {
            const double towards = normals_[i].dot(direction);
            if (towards * nearest.radius > distances_[i]) { nearest = {i + 1, distances_[i] / towards}; }
        }
        return nearest;
    }

    /// Difference of the inverse radii of the two faces: how much nearer the second one is.
    double difference(std::size_t first, std::size_t second, const Eigen::Vector3d& direction) const
    {
        return inverse_radius(second, direction) - inverse_radius(first, direction);
    }

    /// Direction on the edge of two faces that is nearest to the given one.
    Eigen::Vector3d onto_edge(std::size_t first, std::size_t second, const Eigen::Vector3d& direction) const
    {
        if (first > second) { std::swap(first, second); }
        if (first == 0) // a circle about the plane's normal
        {
            const Eigen::Vector3d& normal   = normals_[second - 1];
            const double           distance = distances_[second - 1];
            const Eigen::Vector3d  across   = (direction - direction.dot(normal) * normal).normalized();
            return distance * normal + std::sqrt(1 - distance * distance) * across;
        }
        const Eigen::Vector3d across =
            (normals_[first - 1] / distances_[first - 1] - normals_[second - 1] / distances_[second - 1]).normalized();
        return (direction - direction.dot(across) * across).normalized();
    }

private:
    double inverse_radius(std::size_t face, const Eigen::Vector3d& direction) const
    {
        return face == 0 ? 1 : normals_[face - 1].dot(direction) / distances_[face - 1];
    }

    std::vector<Eigen::Vector3d> normals_;
    std::vector<double>          distances_;
};

using Edge = std::pair<std::size_t, std::size_t>; ///< a pair of faces

/// Moves vertices of a sphere onto the edges and corners of a cut ball.
class Fitting
{
public:
    Fitting(const Cuts& cuts, const TriangleMesh& sphere)
        : cuts_(cuts)
        , mesh(sphere)
        , edges_(sphere.vertices.size())
        , neighbours_(sphere.vertices.size())
    {
        for (const auto& [a, b, c] : sphere.triangles)
        {
            join(a, b); // each side once: the triangle on its other side has it reversed
            join(b, c);
            join(c, a);
        }
    }

    void snap()
    {
        std::vector<std::size_t> faces;
        for (const Eigen::Vector3d& vertex : mesh.vertices) { faces.push_back(cuts_.face(vertex).index); }
        for (std::size_t a = 0; a < neighbours_.size(); ++a)
        {
            for (const std::size_t b : neighbours_[a])
            {
                if (faces[a] == faces[b]) { continue; }
                const double at_a = std::abs(cuts_.difference(faces[a], faces[b], mesh.vertices[a]));
                const double at_b = std::abs(cuts_.difference(faces[a], faces[b], mesh.vertices[b]));
                edges_[at_a <= at_b ? a : b].insert(std::minmax(faces[a], faces[b]));
            }
        }
        for (std::size_t v = 0; v < edges_.size(); ++v) { mesh.vertices[v] = fitted(v, mesh.vertices[v]); }
    }

    /// Moves each vertex towards the middle of its neighbours on the surface, within its face or edge.
    void smooth(const Eigen::Matrix3d& stretch)
    {
        const Eigen::Matrix3d        back = stretch.inverse();
        std::vector<Eigen::Vector3d> surface;
        for (const Eigen::Vector3d& vertex : mesh.vertices)
        {
            surface.emplace_back(stretch * (cuts_.face(vertex).radius * vertex));
        }
        for (std::size_t v = 0; v < edges_.size(); ++v)
        {
            if (edges_[v].size() > 1) { continue; }
            Eigen::Vector3d sum   = Eigen::Vector3d::Zero();
            double          count = 0;
            for (const std::size_t n : neighbours_[v])
            {
                if (!edges_[v].empty() && edges_[n].count(*edges_[v].begin()) == 0) { continue; }
                sum += surface[n];
                count += 1;
            }
            if (count == 0) { continue; }
            const Eigen::Vector3d middle = (back * (0.5 * surface[v] + 0.5 * sum / count)).normalized();
            mesh.vertices[v]             = fitted(v, middle);
        }
    }

    /// Moves the corners of flipped or collapsed triangles back to their original positions, until none is left.
    void unfold(const TriangleMesh& sphere)
    {
        constexpr double flattest = 0.02; // of the original area
        for (bool folded = true; folded;)
        {
            folded = false;
            for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
            {
                if (turn(mesh, t) > flattest * turn(sphere, t)) { continue; }
                for (const std::int32_t v : mesh.triangles[t])
                {
                    const auto at     = static_cast<std::size_t>(v);
                    mesh.vertices[at] = sphere.vertices[at];
                }
                folded = true;
            }
        }
    }

private:
    static double turn(const TriangleMesh& sphere, std::size_t triangle)
    {
        return corner(sphere, triangle, 0).dot(corner(sphere, triangle, 1).cross(corner(sphere, triangle, 2)));
    }

    void join(std::int32_t a, std::int32_t b)
    {
        neighbours_[static_cast<std::size_t>(a)].push_back(static_cast<std::size_t>(b));
    }

    /// Projects onto all edges of a vertex in turn, which converges to their corner. If it ends far off, it has found
    /// another corner.
    Eigen::Vector3d fitted(std::size_t v, const Eigen::Vector3d& start) const
    {
        const auto&     edges = edges_[v];
        Eigen::Vector3d place = start;
        for (std::size_t turns = edges.size() > 1 ? 30 : 1; turns > 0; --turns)
        {
            for (const auto& [first, second] : edges) { place = cuts_.onto_edge(first, second, place); }
        }
        return place;
    }

    const Cuts& cuts_;

public:
    TriangleMesh mesh;

private:
    std::vector<std::set<Edge>>           edges_; ///< that each vertex must lie on; a corner has several
    std::vector<std::vector<std::size_t>> neighbours_;
};

} // namespace

RockCharacter rock_character(std::uint64_t seed)
{
    // The first planes cut deepest and leave a body of few large faces; the others chip its corners.
    constexpr int large = 4, small = 12, waves = 10;

    Random        random(seed);
    RockCharacter character;
    for (int i = 0; i < large + small; ++i)
    {
        const Eigen::Vector3d normal = lonely_direction(random, character.planes);
        if (i < large) { character.planes.push_back({normal, random.uniform(0.85, 1), 0}); }
        else { character.planes.push_back({normal, random.uniform(0.3, 1), 1 / (2 * most_cut)}); }
    }
    for (int i = 0; i < waves; ++i)
    {
        const double number = random.uniform(2, 6);
        character.waves.push_back({number * direction(random), 2 * std::numbers::pi * random.uniform()});
    }
    return character;
}

TriangleMesh rock_directions(const RockCharacter& character, double cut, const Eigen::Matrix3d& stretch,
                             const TriangleMesh& sphere)
{
    constexpr int rounds = 6;
    const Cuts    cuts(character, cut);
    Fitting       fitting(cuts, sphere);
    fitting.snap();
    for (int round = 0; round < rounds; ++round) { fitting.smooth(stretch); }
    fitting.unfold(sphere);
    return fitting.mesh;
}

TriangleMesh rock_surface(const RockCharacter& character, const RockHandles& handles, const TriangleMesh& directions)
{
    const Cuts          cuts(character, handles.cut);
    std::vector<double> heights;
    double              largest = 0;
    for (const Eigen::Vector3d& vertex : directions.vertices)
    {
        heights.push_back(0);
        for (const auto& wave : character.waves) { heights.back() += std::cos(wave.number.dot(vertex) + wave.phase); }
        largest = std::max(largest, std::abs(heights.back()));
    }
    TriangleMesh mesh = directions;
    for (std::size_t v = 0; v < heights.size(); ++v)
    {
        const double radius = cuts.face(mesh.vertices[v]).radius * (1 + handles.dent * heights[v] / largest);
        mesh.vertices[v]    = handles.stretch * (radius * mesh.vertices[v]);
    }
    return mesh;
}

} // namespace tread::shape
