#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "base/errors.hpp"
#include "shape/generators/form.hpp"
#include "shape/generators/generators.hpp"

// Prints the table of docs/shapes.md: requested forms of rocks, and measured forms for 20 seeds of each recipe.
namespace
{

using namespace tread;

constexpr int seeds = 20;

struct Recipe
{
    double aspect, elongation, sphericity, solidity;
};

struct Spread
{
    double sum = 0, least = 1e9, most = 0;

    void add(double value)
    {
        sum += value;
        least = std::min(least, value);
        most  = std::max(most, value);
    }
};

void print_row(const Recipe& recipe)
{
    std::array<Spread, 4> spreads;
    int                   made = 0;
    for (int seed = 1; seed <= seeds; ++seed)
    {
        scene::RockGenerator rock{};
        rock.seed       = static_cast<std::uint64_t>(seed);
        rock.aspect     = recipe.aspect;
        rock.elongation = recipe.elongation;
        rock.sphericity = recipe.sphericity;
        rock.solidity   = recipe.solidity;
        try
        {
            const shape::Form form = shape::form_of(shape::rock_mesh(rock, "rock"));
            spreads[0].add(form.aspect);
            spreads[1].add(form.elongation);
            spreads[2].add(form.sphericity);
            spreads[3].add(form.solidity);
            ++made;
        }
        catch (const InputError& error)
        {
            std::fprintf(stderr, "seed %d: %s\n", seed, error.what());
        }
    }
    const std::array asked{recipe.aspect, recipe.elongation, recipe.sphericity, recipe.solidity};
    for (std::size_t i = 0; i < asked.size(); ++i)
    {
        const Spread& spread = spreads[i];
        std::printf("| %.3f: %.3f (%.3f to %.3f) ", asked[i], spread.sum / made, spread.least, spread.most);
    }
    std::printf("| %d of %d |\n", made, seeds);
}

} // namespace

int main()
{
    std::printf("| aspect | elongation | sphericity | solidity | seeds |\n|---|---|---|---|---|\n");
    for (const Recipe& recipe : {Recipe{0.75, 0.875, 0.90, 0.98},
                                 {0.55, 0.775, 0.90, 0.98},
                                 {0.84, 0.92, 0.86, 0.97},
                                 {0.70, 0.85, 0.80, 0.95},
                                 {0.54, 0.77, 0.75, 0.92},
                                 {0.50, 0.55, 0.85, 0.97},
                                 {0.30, 0.90, 0.70, 0.98},
                                 {0.90, 0.95, 0.96, 0.99}})
    {
        print_row(recipe);
    }
}
