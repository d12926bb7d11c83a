#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kernels/dem/bodies.hpp"
#include "kernels/dem/motion/mass_scaling.hpp"
#include "kernels/dem/pairs/pairs.hpp"
#include "scene/scene.hpp"
#include "solver/bodies/body_tables.hpp"
#include "solver/plan.hpp"
#include "solver/ranks/body_ranks.hpp"
#include "world/world.hpp"

namespace tread::solver
{

class StateFile;

/// Bodies of a scene on one backend, their pairs, and what stays constant: the data that all parts of DemSolver work
/// on.
template<class Exec>
struct BodyState
{
    /// Bodies at their start and at rest, named ones locked, without pairs. InputError if there are more bodies and
    /// walls than pair keys can tell apart. `decomposition`: null on one rank.
    BodyState(const Exec& backend, const scene::Scene& of_scene, const world::World& of_world, const Plan& plan,
              decomp::Decomposition<Exec>* decomposition);

    dem::BodiesView view() { return bodies.view(); }
    std::int64_t    named() const { return world.bodies.named; }

    /// Numbers of the bodies that this rank has rows for.
    const BodyNumbers& numbers() const { return ranks ? ranks->numbers() : every; }

    /// Name for messages of a row's body: that of a named body, or "rock 17".
    std::string name(std::int64_t row) const { return name_of_number(numbers().number(row)); }
    std::string name_of_number(std::int64_t number) const;

    /// m, radius of the sphere of equal volume of each row's body; of a wheel, that of its rim.
    std::vector<double> radii() const;

    /// Passes changes of the bodies on to the data that contacts read.
    void stage() { dem::stage_bodies(exec, pairs, bodies.view()); }

    /// Whether this rank integrates a row's body and accounts for its energy.
    bool owns(std::int64_t row) const { return !ranks || ranks->owns(row); }

    /// Whether this rank shares bodies with others, so that every substep exchanges messages.
    bool            shares() const { return ranks && ranks->shares(); }
    dem::SharedView shared() { return ranks ? ranks->shared().view() : dem::SharedView{}; }

    /// Null on one rank.
    const Communicator* communicator() const { return ranks ? &ranks->communicator() : nullptr; }

    /// Order of the bodies in files; valid until they change owners. Collective.
    BodyBlocks blocks() const { return ranks ? ranks->blocks() : BodyBlocks(); }

    /// Moves bodies to the ranks that now own them (BodyRanks::assign_owners); several ranks only.
    void assign_owners(UnheldRows unheld)
    {
        ranks->assign_owners({bodies, pairs, tables.bounding_radii, scales_inertia ? &inertia_factor : nullptr},
                             unheld);
    }

    /// Change of rows in the last assign_owners(); null where there was none.
    const RowMoves<Exec>* row_moves() const { return ranks ? ranks->row_moves() : nullptr; }

    /// Saves or loads the bodies, and where the state is exact their owners, but not their pairs.
    void transfer(StateFile& file);

    Exec                           exec;
    const scene::Scene&            scene;
    const world::World&            world;
    BodyNumbers                    every;          ///< all bodies, for which one rank has rows
    Vec3<double>                   gravity;        ///< m/s2
    double                         mass = 0;       ///< kg, of all bodies
    bool                           has_contact;    ///< whether a body may touch another or a wall
    bool                           scales_inertia; ///< Plan::mass_scaling
    dem::MassScaling               mass_scaling;   ///< of the present phase
    BodyTables<Exec>               tables;
    dem::Bodies<Exec>              bodies;
    dem::Pairs<Exec>               pairs;
    Array<Exec, double>            inertia_factor; ///< InertiaScaling::factor; empty where no inertia is scaled
    std::optional<BodyRanks<Exec>> ranks;          ///< only on several ranks
};

} // namespace tread::solver
