#include "solver/ranks/over_ranks.hpp"

namespace tread::solver
{

double largest_over_ranks(const Communicator* communicator, double value)
{
    if (communicator != nullptr) { decomp::combine(*communicator, &value, 0, 1); }
    return value;
}

double smallest_over_ranks(const Communicator* communicator, double value)
{
    if (communicator == nullptr) { return value; }
    double least = 0;
    for (const double other : communicator->gather(value))
    {
        if (other > 0 && (least == 0 || other < least)) { least = other; }
    }
    return least;
}

} // namespace tread::solver
