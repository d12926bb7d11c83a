#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "backend.hpp"
#include "decomposition_options.hpp"
#include "mpi_session.hpp"
#include "run/time_loop.hpp"
#include "scene_text.hpp"
#include "solver/ranks/page_loads.hpp"
#include "solver/simulation.hpp"

// Runs a scene with the solver's components, on all ranks together or on this one alone.
namespace tread::test
{

/// Returns the rank that owns the page at given coordinates; empty: the partitioner's choice.
using OwnerOf = std::function<int(mpm::Index3)>;

enum class Ranks
{
    all,
    this_one
};

template<class Exec, class Real>
class RankRun
{
public:
    RankRun(const Exec& exec, const std::string& text, Ranks ranks, const OwnerOf& owner_of = {},
            const decomp::DecompositionOptions& options = decomposition_options())
        : scene_(load_text(text))
        , world_(world::build_world(scene_))
    {
        if (ranks == Ranks::all) { decompose(exec, owner_of, options); }
        simulation_ = std::make_unique<solver::Simulation<Exec, Real>>(
            exec, scene_, world_, solver::make_plan(scene_, world_, decomposition_ ? test::world().size() : 1),
            decomposition_.get());
        loop_ = std::make_unique<tread::run::TimeLoop<Exec, Real>>(scene_, world_, *simulation_);
        world::release_rocks(world_);
        simulation_->begin();
    }

    void step(int steps)
    {
        for (int i = 0; i < steps; ++i) { tread::run::take_step(*loop_, {}); }
    }

    solver::Simulation<Exec, Real>& simulation() { return *simulation_; }
    double                          time() const { return loop_->progress.time; }

    /// Transport of a run on all ranks.
    const decomp::Transport<Exec>& transport() const { return decomposition_->transport; }

    /// Owners of the pages of a run on all ranks.
    const decomp::PageMap<Exec>& owners() const { return decomposition_->owners; }

    /// Where the scene's bodies and sand are.
    const world::World& scene_world() const { return world_; }

    /// Fields of this rank's points.
    io::PointFields points() { return simulation_->point_fields(); }

    /// Energy balance after a census.
    solver::EnergyRow energy() { return simulation_->ledger().energy(simulation_->census()); }

private:
    void decompose(const Exec& exec, const OwnerOf& owner_of, const decomp::DecompositionOptions& options)
    {
        decomposition_ = std::make_unique<decomp::Decomposition<Exec>>(test::world(), exec, options);
        solver::share_out(*decomposition_, world_);
        if (owner_of) { assign(owner_of); }
    }

    /// Assigns owners to all pages of the domain, and some around it.
    void assign(const OwnerOf& owner_of)
    {
        const double                               edge = mpm::page_edge * solver::page_lattice_of(world_).spacing;
        std::vector<std::pair<std::uint64_t, int>> owned;
        const auto last = [&](int axis) { return static_cast<std::int32_t>(world_.geometry.size[axis] / edge) + 2; };
        for (std::int32_t z = -2; z <= last(2); ++z)
        {
            for (std::int32_t y = -2; y <= last(1); ++y)
            {
                for (std::int32_t x = -2; x <= last(0); ++x)
                {
                    owned.emplace_back(mpm::page_key({x, y, z}), owner_of({x, y, z}) % test::world().size());
                }
            }
        }
        std::sort(owned.begin(), owned.end());
        std::vector<std::uint64_t> keys;
        decomp::PageRanks          ranks;
        for (const auto& [key, rank] : owned)
        {
            keys.push_back(key);
            ranks.push_back(rank);
        }
        decomposition_->owners.assign(keys, ranks);
    }

    scene::Scene                                      scene_;
    world::World                                      world_;
    std::unique_ptr<decomp::Decomposition<Exec>>      decomposition_;
    std::unique_ptr<solver::Simulation<Exec, Real>>   simulation_;
    std::unique_ptr<tread::run::TimeLoop<Exec, Real>> loop_;
};

} // namespace tread::test
