#include "shape/generators/form.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "shape/mesh/convex_hull.hpp"
#include "shape/mesh/triangle.hpp"
#include "shape/solids/mass_properties.hpp"

namespace tread::shape
{
namespace
{

double width(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& direction)
{
    double low = points[0].dot(direction), high = low;
    for (const Eigen::Vector3d& point : points)
    {
        const double along = point.dot(direction);
        low                = std::min(low, along);
        high               = std::max(high, along);
    }
    return high - low;
}

struct Width
{
    double          length;
    Eigen::Vector3d direction;

    bool operator<(const Width& other) const { return length < other.length; }
};

/// Directions distributed evenly over half the unit sphere (Fibonacci lattice): a width has no sign.
std::vector<Eigen::Vector3d> half_sphere(int count)
{
    std::vector<Eigen::Vector3d> directions;
    for (int i = 0; i < count; ++i)
    {
        const double height = (i + 0.5) / count;
        const double turn   = i * std::numbers::pi * (3 - std::sqrt(5.0));
        const double reach  = std::sqrt(1 - height * height);
        directions.emplace_back(reach * std::cos(turn), reach * std::sin(turn), height);
    }
    return directions;
}

/// Smallest width near `start`: the best of a patch of directions, about which a smaller patch follows. Gradient
/// descent would stop at the kinks of a polyhedron's width.
Width least_near(const std::vector<Eigen::Vector3d>& points, Width start, double step)
{
    constexpr int    reach  = 2;
    constexpr double finest = 1e-7; // rad: changes a width by at most 1e-7 of the largest extent
    while (step > finest)
    {
        const Eigen::Vector3d across = start.direction.unitOrthogonal();
        const Eigen::Vector3d along  = start.direction.cross(across);
        Width                 best   = start;
        for (int i = -reach; i <= reach; ++i)
        {
            for (int j = -reach; j <= reach; ++j)
            {
                const Eigen::Vector3d direction =
                    (start.direction + step / reach * (i * across + j * along)).normalized();
                best = std::min(best, {width(points, direction), direction});
            }
        }
        // The best direction is at the rim of the patch: the minimum may lie beyond, so the patch moves before it
        // shrinks.
        if (best.direction.dot(start.direction) > std::cos(0.75 * step)) { step *= 0.5; }
        start = best;
    }
    return start;
}

Width least_width(const std::vector<Eigen::Vector3d>& points)
{
    constexpr int    directions = 400, starts = 4;
    constexpr double apart = 0.125; // rad: about the distance between neighbours

    std::vector<Width> widths;
    for (const Eigen::Vector3d& direction : half_sphere(directions))
    {
        widths.push_back({width(points, direction), direction});
    }
    std::stable_sort(widths.begin(), widths.end());
    Width              best = widths[0];
    std::vector<Width> tried;
    for (const Width& start : widths)
    {
        const auto neighbours = [&](const Width& other)
        { return std::abs(other.direction.dot(start.direction)) > std::cos(2 * apart); };
        if (std::any_of(tried.begin(), tried.end(), neighbours)) { continue; }
        tried.push_back(start);
        best = std::min(best, least_near(points, start, apart));
        if (tried.size() == starts) { break; }
    }
    return best;
}

/// Smallest width perpendicular to `axis`. A silhouette is narrowest perpendicular to one of its sides (Freeman &
/// Shapira 1975, Commun. ACM 18:409), but most points are inside the silhouette: so the search is as in space, on a
/// half circle.
Width least_width_across(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& axis)
{
    constexpr int         turns = 180;
    const Eigen::Vector3d one = axis.unitOrthogonal(), other = axis.cross(one);
    const auto            at = [&](double turn)
    {
        const Eigen::Vector3d direction = std::cos(turn) * one + std::sin(turn) * other;
        return std::pair(Width{width(points, direction), direction}, turn);
    };
    const auto narrower = [](const auto& a, const auto& b) { return a.first < b.first; };

    auto best = at(0);
    for (int i = 1; i < turns; ++i) { best = std::min(best, at(std::numbers::pi * i / turns), narrower); }
    constexpr int halvings = 20; // to 1e-8 of a turn
    double        step     = 0.5 * std::numbers::pi / turns;
    for (int halving = 0; halving < halvings; ++halving)
    {
        const double turn = best.second;
        best              = std::min({best, at(turn - step), at(turn + step)}, narrower);
        step *= 0.5;
    }
    return best.first;
}

} // namespace

Extents extents(const std::vector<Eigen::Vector3d>& hull_vertices)
{
    const Width           minor        = least_width(hull_vertices);
    const Width           intermediate = least_width_across(hull_vertices, minor.direction);
    const Eigen::Vector3d across       = intermediate.direction.cross(minor.direction);

    Extents result;
    result.lengths << width(hull_vertices, across), intermediate.length, minor.length;
    result.axes << across, intermediate.direction, minor.direction;
    return result;
}

double sphericity(const TriangleMesh& mesh)
{
    return std::cbrt(std::numbers::pi) * std::pow(6 * mass_properties(mesh).volume, 2.0 / 3.0) / surface_area(mesh);
}

Form form_of(const TriangleMesh& mesh)
{
    const TriangleMesh    hull    = convex_hull(mesh.vertices);
    const Eigen::Vector3d lengths = extents(hull.vertices).lengths;
    return {lengths[2] / lengths[0], lengths[1] / lengths[0], sphericity(mesh),
            mass_properties(mesh).volume / mass_properties(hull).volume};
}

std::string form_table(const std::vector<NamedForm>& forms)
{
    const auto line = [](const std::string& name, const Form& form)
    {
        return fmt::format("{:<15} {:>7.3f} {:>10.3f} {:>10.3f} {:>8.3f}\n", name, form.aspect, form.elongation,
                           form.sphericity, form.solidity);
    };
    std::string text =
        fmt::format("{:<15} {:>7} {:>10} {:>10} {:>8}\n", "", "aspect", "elongation", "sphericity", "solidity");
    for (const NamedForm& named : forms) { text += line(named.name, named.form); }
    if (forms.size() < 2) { return text; }

    Form least = forms[0].form, most = least, mean{};
    for (const NamedForm& named : forms)
    {
        for (double Form::*factor : {&Form::aspect, &Form::elongation, &Form::sphericity, &Form::solidity})
        {
            least.*factor = std::min(least.*factor, named.form.*factor);
            most.*factor  = std::max(most.*factor, named.form.*factor);
            mean.*factor += named.form.*factor / static_cast<double>(forms.size());
        }
    }
    return text + line("mean", mean) + line("least", least) + line("most", most);
}

} // namespace tread::shape
