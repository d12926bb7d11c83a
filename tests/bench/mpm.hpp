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
    collapsing ///< a collapsing column
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

/// Times whole MPM steps of pure sand, including ordering, and its kernels one by one. Prints points per second and
/// allocated bytes per point.
void run_mpm(const MpmCase& what);

/// Whether `points` is the number on each rank or on all ranks.
enum class Scaling
{
    weak,
    strong
};

/// Does so on all ranks of the communicator: whole steps, the parts of rank 0's step, imbalance, bytes per point. Under
/// mpirun with increasing numbers of ranks these are the figures of weak or strong scaling.
void run_scaling(const Communicator& communicator, MpmCase what, Scaling scaling, decomp::TransportChoice transport);

} // namespace tread::bench
