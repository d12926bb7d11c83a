#pragma once

#include <cstdint>

#include "backend_choice.hpp"
#include "decomp/transport.hpp"
#include "scene/scene.hpp"

namespace tread::bench
{

enum class SandState
{
    settled,   ///< a bed at rest between slip walls
    collapsing ///< a column that falls apart
};

struct MpmCase
{
    std::int64_t         points    = 1'000'000;
    int                  per_cell  = 8; ///< 1, 8, 27, 64
    scene::MaterialModel law       = scene::MaterialModel::mohr_coulomb;
    SandState            state     = SandState::settled;
    scene::Transfer      transfer  = scene::Transfer::aflip;
    scene::Precision     precision = scene::Precision::single_;
    Backend              backend   = Backend::cpu;
    int                  steps     = 200; ///< timed, three times
};

/// Times whole MPM steps of pure sand, ordering included, and its kernels one by one; prints points a second and the
/// bytes a point that were allocated.
void run_mpm(const MpmCase& what);

/// Whether `points` are each rank's or all ranks'.
enum class Scaling
{
    weak,
    strong
};

/// The same on all ranks of the communicator: whole steps, the parts of rank 0's step, imbalance, bytes a point. Under
/// mpirun with one rank after the other these are the figures of weak or strong scaling.
void run_scaling(const Communicator& communicator, MpmCase what, Scaling scaling, decomp::TransportChoice transport);

} // namespace tread::bench
