#pragma once

#include <vector>

#include "kernels/dem/bodies.hpp"
#include "solver/device_templates.hpp"
#include "solver/ledger.hpp"
#include "solver/phases.hpp"
#include "solver/recorder.hpp"
#include "solver/world.hpp"

namespace tread::solver
{

/// The rigid bodies of a scene on one backend: their state, their pairs, and the calls of a substep.
template<class Exec>
class Rigid
{
public:
    Rigid(const Exec& exec, const scene::Scene& scene, const World& world);
    ~Rigid();
};

} // namespace tread::solver
