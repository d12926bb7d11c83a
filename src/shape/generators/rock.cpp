#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include <Eigen/LU>
#include <fmt/format.h>

#include "base/errors.hpp"
#include "base/random.hpp"
#include "shape/generators/form.hpp"
#include "shape/generators/generators.hpp"
#include "shape/generators/rock_body.hpp"
#include "shape/mesh/convex_hull.hpp"
#include "shape/solids/mass_properties.hpp"

namespace tread::shape
{
namespace
{

constexpr double tolerance = 0.03;  ///< relative, of the guaranteed form
constexpr double sought    = 0.005; ///< relative, at which the search stops

Form requested_form(const scene::RockGenerator& generator)
{
    return {generator.aspect, generator.elongation.value_or(0.5 * (1 + generator.aspect)), generator.sphericity,
            generator.solidity};
}

void require_within(const std::string& origin, const char* key, double value, double low, double high)
{
    if (value >= low && value <= high) { return; }
    throw InputError(fmt::format("{}: {} = {}: accepted are {:.4g} to {:.4g}", origin, key, value, low, high));
}

void check(const scene::RockGenerator& generator, const std::string& origin)
{
    require_within(origin, "aspect", generator.aspect, 0.2, 1);
    if (generator.elongation) { require_within(origin, "elongation", *generator.elongation, generator.aspect, 1); }
    require_within(origin, "sphericity", generator.sphericity, 0.3, 1);
    require_within(origin, "solidity", generator.solidity, 0.5, 1);
    require_within(origin, "nodes", generator.nodes, 20, 20000);
}

double largest_error(const Form& form, const Form& wanted)
{
    double largest = 0;
    for (double Form::*factor : {&Form::aspect, &Form::elongation, &Form::sphericity, &Form::solidity})
    {
        largest = std::max(largest, std::abs(form.*factor / wanted.*factor - 1));
    }
    return largest;
}

struct Rock
{
    RockHandles     handles;
    TriangleMesh    mesh;
    Eigen::Matrix3d axes; ///< directions of its extents, one per column
    Form            form;
};

/// Rocks of one character and one ratio of extents, with as many vertices as `sphere`.
struct Quarry
{
    const RockCharacter& character;
    const TriangleMesh&  sphere;
    double               aspect;
    double               elongation;

    /// The rock with these handles, stretched further until it has the requested extents.
    Rock rock(const RockHandles& handles, const TriangleMesh& directions) const
    {
        constexpr int    rounds = 12;
        constexpr double enough = 1e-3;

        Rock               rock{handles, rock_surface(character, handles, directions), {}, {}};
        const TriangleMesh hull  = convex_hull(rock.mesh.vertices);
        const double       solid = mass_properties(rock.mesh).volume / mass_properties(hull).volume;
        auto               shell = hull.vertices;
        for (int round = 0;; ++round)
        {
            const Extents         found = extents(shell);
            const Eigen::Vector3d ratios(1, elongation * found.lengths[0] / found.lengths[1],
                                         aspect * found.lengths[0] / found.lengths[2]);
            rock.axes = found.axes;
            rock.form = {found.lengths[2] / found.lengths[0], found.lengths[1] / found.lengths[0],
                         sphericity(rock.mesh), solid};
            if (round == rounds || (ratios.array() - 1).abs().maxCoeff() < enough) { return rock; }

            Eigen::Matrix3d stretch = found.axes * ratios.asDiagonal() * found.axes.transpose();
            stretch /= std::cbrt(stretch.determinant());
            rock.handles.stretch = stretch * rock.handles.stretch;
            for (Eigen::Vector3d& vertex : shell) { vertex = stretch * vertex; }
            for (Eigen::Vector3d& vertex : rock.mesh.vertices) { vertex = stretch * vertex; }
        }
    }

    double solidity(const RockHandles& handles, const TriangleMesh& directions) const
    {
        const TriangleMesh mesh = rock_surface(character, handles, directions);
        return mass_properties(mesh).volume / mass_properties(convex_hull(mesh.vertices)).volume;
    }

    /// Dent that meets the solidity as nearly as possible for the given cut and stretch.
    double dent(RockHandles handles, const TriangleMesh& directions, double wanted) const
    {
        constexpr double enough = 5e-4;
        double           low = 0, high = most_dent;
        for (double next = handles.dent > 0 ? handles.dent : 0.1; high - low > 1e-4; next = 0.5 * (low + high))
        {
            handles.dent       = next;
            const double found = solidity(handles, directions);
            if (std::abs(found - wanted) < enough) { return next; }
            (found > wanted ? low : high) = next;
        }
        return 0.5 * (low + high);
    }

    /// The rock with this cut and the requested solidity, starting from nearby handles.
    Rock rock_of_solidity(RockHandles handles, double wanted) const
    {
        const TriangleMesh directions = rock_directions(character, handles.cut, handles.stretch, sphere);
        handles.dent                  = dent(handles, directions, wanted);
        return rock(handles, directions);
    }

    /// Searches the cut: a deeper cut gives a lower sphericity.
    Rock rock_of_form(double sphericity, double solidity) const
    {
        constexpr int    halvings = 14;
        constexpr double enough   = 1e-3;

        Rock   best = rock_of_solidity({}, solidity);
        double low = 0, high = most_cut;
        for (int halving = 0; halving < halvings && std::abs(best.form.sphericity - sphericity) > enough; ++halving)
        {
            RockHandles handles                              = best.handles;
            handles.cut                                      = 0.5 * (low + high);
            best                                             = rock_of_solidity(handles, solidity);
            (best.form.sphericity > sphericity ? low : high) = handles.cut;
        }
        return best;
    }
};

/// Attainable range of rocks of one character at the requested form.
struct Yield
{
    double least_solidity;
    double least_sphericity; ///< at the requested solidity
    double most_sphericity;
};

Yield yield_of(const Quarry& quarry, double solidity)
{
    const Rock  roundest = quarry.rock_of_solidity({}, solidity);
    RockHandles handles  = roundest.handles;
    handles.cut          = most_cut;
    const Rock edgiest   = quarry.rock_of_solidity(handles, solidity);
    return {std::max(roundest.form.solidity, edgiest.form.solidity), edgiest.form.sphericity, roundest.form.sphericity};
}

bool contains(const Yield& yield, const Form& wanted)
{
    return yield.least_solidity < wanted.solidity * (1 + tolerance) &&
           yield.least_sphericity < wanted.sphericity * (1 + tolerance) &&
           yield.most_sphericity > wanted.sphericity * (1 - tolerance);
}

/// Searches among rocks of few vertices, correcting for their difference from rocks of many.
Rock search(const Quarry& coarse, const Quarry& fine, const Form& wanted)
{
    constexpr int rounds = 4;

    double              sphericity = wanted.sphericity, solidity = wanted.solidity;
    std::optional<Rock> best;
    for (int round = 0; round < rounds; ++round)
    {
        const RockHandles handles = coarse.rock_of_form(sphericity, solidity).handles;
        const Rock        rock =
            fine.rock(handles, rock_directions(fine.character, handles.cut, handles.stretch, fine.sphere));
        if (!best || largest_error(rock.form, wanted) < largest_error(best->form, wanted)) { best = rock; }
        if (largest_error(best->form, wanted) < sought) { break; }
        sphericity += wanted.sphericity - rock.form.sphericity;
        solidity += wanted.solidity - rock.form.solidity;
    }
    return *best;
}

/// Attainable ranges of all characters drawn, for the message.
struct Draws
{
    Yield               widest{1, 1, 0};
    std::optional<Rock> nearest;
};

void add(Draws& draws, const Yield& yield)
{
    draws.widest = {std::min(draws.widest.least_solidity, yield.least_solidity),
                    std::min(draws.widest.least_sphericity, yield.least_sphericity),
                    std::max(draws.widest.most_sphericity, yield.most_sphericity)};
}

[[noreturn]] void fail(const Draws& draws, std::uint64_t seed, const Form& wanted, double ball,
                       const std::string& origin)
{
    const std::string requested = fmt::format("aspect {:.4g}, elongation {:.4g}, sphericity {:.4g} and solidity {:.4g}",
                                              wanted.aspect, wanted.elongation, wanted.sphericity, wanted.solidity);
    if (draws.nearest)
    {
        const Form& form = draws.nearest->form;
        throw InputError(fmt::format("{}: no rock of seed {} with {} was found; the nearest has {:.3f}, {:.3f}, {:.3f} "
                                     "and {:.3f}",
                                     origin, seed, requested, form.aspect, form.elongation, form.sphericity,
                                     form.solidity));
    }
    if (draws.widest.least_solidity > wanted.solidity * (1 + tolerance))
    {
        throw InputError(fmt::format("{}: solidity = {}: with seed {}, {:.3f} to 1 can be reached", origin,
                                     wanted.solidity, seed, draws.widest.least_solidity));
    }
    throw InputError(fmt::format("{}: sphericity = {}: with seed {}, {}, {:.3f} to {:.3f} can be reached; the "
                                 "ellipsoid of these extents has {:.3f}",
                                 origin, wanted.sphericity, seed, requested, draws.widest.least_sphericity,
                                 draws.widest.most_sphericity, ball));
}

/// First of a few characters derived from the seed whose rocks can have the form.
Rock drawn_rock(std::uint64_t seed, const Form& wanted, const std::string& origin)
{
    constexpr int      most_draws = 8;
    const TriangleMesh few = icosphere(642, origin), many = icosphere(2562, origin);
    Random             seeds(seed);
    Draws              draws;
    for (int draw = 0; draw < most_draws; ++draw)
    {
        const RockCharacter character = rock_character(draw == 0 ? seed : seeds.next());
        const Quarry        coarse{character, few, wanted.aspect, wanted.elongation};
        const Yield         yield = yield_of(coarse, wanted.solidity);
        add(draws, yield);
        if (!contains(yield, wanted)) { continue; }
        Rock rock = search(coarse, {character, many, wanted.aspect, wanted.elongation}, wanted);
        if (largest_error(rock.form, wanted) < tolerance) { return rock; }
        if (!draws.nearest || largest_error(rock.form, wanted) < largest_error(draws.nearest->form, wanted))
        {
            draws.nearest = rock;
        }
    }
    const TriangleMesh ball = Quarry{rock_character(seed), many, wanted.aspect, wanted.elongation}.rock({}, many).mesh;
    fail(draws, seed, wanted, sphericity(ball), origin);
}

} // namespace

TriangleMesh rock_mesh(const scene::RockGenerator& generator, const std::string& origin)
{
    check(generator, origin);
    const Rock   rock  = drawn_rock(generator.seed, requested_form(generator), origin);
    TriangleMesh mesh  = rock.mesh;
    const double scale = std::cbrt(std::numbers::pi / 6 / mass_properties(mesh).volume);
    for (Eigen::Vector3d& vertex : mesh.vertices) { vertex = scale * (rock.axes.transpose() * vertex); }
    return mesh;
}

} // namespace tread::shape
