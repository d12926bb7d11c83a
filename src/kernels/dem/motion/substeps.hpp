#pragma once

#include "kernels/dem/motion/move.hpp"

namespace tread::dem
{

/// Calls run(exec, step) `count` times, with the numbers of the substeps: those after step.limit.last do nothing.
template<class Exec, class Run>
void each_substep(const Exec& exec, const BodyStep<Exec>& step, std::int64_t count, const Run& run)
{
    Exec           numbered = exec;
    BodyStep<Exec> each     = step;
    each.limit.repeated     = nullptr;
    for (std::int64_t done = 0; done < count; ++done, ++each.limit.substep)
    {
        numbered.number = {each.limit.last, each.limit.substep};
        run(numbered, each);
    }
}

/// Runs evaluate_contacts and move_bodies `count` times with motion.dt (s), without host work in between, or until
/// step.limit.last. Allocates nothing.
template<class Exec>
void run_substeps(const Exec&, const BodyStep<Exec>& step, std::int64_t count);

} // namespace tread::dem
