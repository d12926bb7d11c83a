#include "solver/touch_change.hpp"

namespace tread::solver
{

bool TouchChange::any_begins() const
{
    for (std::size_t pair = 0; pair < after.touch.size(); ++pair)
    {
        if (after.touch[pair] != 0 && before.touch[pair] == 0) { return true; }
    }
    return false;
}

NewTouch together(const NewTouch& one, const NewTouch& other)
{
    NewTouch all = other.overlap > one.overlap ? other : one;
    all.points   = one.points + other.points;
    return all;
}

double released(const TouchChange& change, const std::vector<double>& energies)
{
    const std::size_t sides = change.after.sides;
    double            sum   = 0;
    for (std::size_t pair = 0; pair < energies.size(); ++pair)
    {
        if (change.ends(pair / sides, pair % sides)) { sum += energies[pair]; }
    }
    return sum;
}

} // namespace tread::solver
