#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "decomp/messages.hpp"
#include "decomposition_options.hpp"
#include "mpi_session.hpp"
#include "physics/harness.hpp"
#include "solver/ranks/page_loads.hpp"

// Runs a scene on all ranks together and on this rank alone; the latter is the reference.
namespace tread::test
{

/// Pages of a box from the origin on, owned by the rank that owner(centre of a page) returns.
struct OwnedPages
{
    std::vector<std::uint64_t> key;
    decomp::PageRanks          rank;
};

template<class Owner>
OwnedPages pages_of(const decomp::PageLattice& lattice, const Vec3<double>& size, Owner owner)
{
    const double width = mpm::page_edge * lattice.spacing;
    const auto   pages = [&](int c) { return static_cast<std::int32_t>(std::ceil(size[c] / width)) + 1; };

    std::vector<std::pair<std::uint64_t, std::int32_t>> owned;
    for (std::int32_t x = -1; x < pages(0); ++x)
    {
        for (std::int32_t y = -1; y < pages(1); ++y)
        {
            for (std::int32_t z = -1; z < pages(2); ++z)
            {
                const Vec3<double> centre = width * (Vec3<double>(x, y, z) + Vec3<double>::Constant(0.5));
                owned.emplace_back(mpm::page_key({x, y, z}), owner(centre));
            }
        }
    }
    std::sort(owned.begin(), owned.end());
    OwnedPages found;
    for (const auto& [key, rank] : owned)
    {
        found.key.push_back(key);
        found.rank.push_back(rank);
    }
    return found;
}

/// Slabs along x of equal width, for the first `parts` ranks.
inline auto slabs(double length, int parts)
{
    return [=](const Vec3<double>& at)
    { return std::clamp(static_cast<int>(std::floor(parts * at[0] / length)), 0, parts - 1); };
}

/// Quarters that meet at an edge above `centre`, for as many ranks as there are; with three ranks one owns the last two
/// quarters.
inline auto quarters(const Vec3<double>& centre, int ranks)
{
    return [=](const Vec3<double>& at)
    { return std::min((at[0] > centre[0] ? 1 : 0) + (at[1] > centre[1] ? 2 : 0), ranks - 1); };
}

/// Largest difference of two lists of numbers, relative to `scale`.
inline double difference(const std::vector<double>& one, const std::vector<double>& other, double scale)
{
    EXPECT_EQ(one.size(), other.size());
    double largest = 0;
    for (std::size_t i = 0; i < one.size(); ++i) { largest = std::max(largest, std::abs(one[i] - other[i]) / scale); }
    return largest;
}

/// Errors of the ledger with this census, which it knows only once it is asked for its rows.
template<class Exec>
auto errors_of(Experiment<Exec>& experiment, const solver::Census& now)
{
    solver::Ledger& ledger = experiment.simulation().ledger();
    ledger.energy(now);
    ledger.balance(now);
    return ledger.errors();
}

/// Expects that all holders of a body have its state to the bit, and returns how many ghosts were compared. Collective.
template<class Exec>
int compare_holders(solver::DemSolver<Exec>& rigid)
{
    using State                          = std::array<double, 23>; // number, place, motion, force, allowed way, sleep
    const std::vector<std::int32_t> role = rigid.bodies().role.to_host();
    const auto position = rigid.bodies().position.to_host(), velocity = rigid.bodies().velocity.to_host(),
               spin = rigid.bodies().angular_velocity.to_host(), force = rigid.bodies().force.to_host(),
               torque                   = rigid.bodies().torque.to_host();
    const std::vector<Quat>   turned    = rigid.bodies().orientation.to_host();
    const std::vector<double> stiffness = rigid.bodies().stiffness.to_host();
    const std::vector<double> allowed   = rigid.pairs().displacement.allowed.to_host();
    std::vector<std::int32_t> asleep    = rigid.bodies().asleep.to_host();
    asleep.resize(role.size(), 0);
    std::vector<State> held;
    for (std::size_t row = 0; row < role.size(); ++row)
    {
        if (role[row] == dem::role_none) { continue; }
        State& state = held.emplace_back();
        auto   to    = state.begin();
        *to++        = static_cast<double>(rigid.numbers().number(static_cast<std::int64_t>(row)));
        for (const auto* field : {&position, &velocity, &spin, &force, &torque})
        {
            to = std::copy((*field)[row].data(), (*field)[row].data() + 3, to);
        }
        to    = std::copy(turned[row].coeffs().data(), turned[row].coeffs().data() + 4, to);
        *to++ = stiffness[row];
        *to++ = allowed[row];
        *to   = asleep[row];
    }
    std::map<double, State> of_first;
    int                     ghosts = 0;
    for (const std::vector<State>& of_rank : decomp::gather_values(world(), held))
    {
        for (const State& state : of_rank)
        {
            const auto [first, is_first] = of_first.try_emplace(state[0], state);
            if (is_first) { continue; }
            ++ghosts;
            EXPECT_EQ(first->second, state) << "body " << state[0];
        }
    }
    return ghosts;
}

enum class Owners
{
    stay,  ///< page owners as assigned by the test
    change ///< repartitioned by the scene's balance rule
};

template<class Exec>
class SideBySide
{
public:
    /// owner(place) names a rank for every position in a box of this size (m) from the origin on.
    template<class Owner>
    SideBySide(const Exec& exec, const scene::Scene& scene, const Vec3<double>& size, Owner owner,
               Owners owners = Owners::stay)
        : built_(world::build_world(scene))
        , decomposition_(world(), exec, test::decomposition_options())
        , alone(exec, scene, built_)
        , together(exec, with(owners, scene), built_, given(size, owner))
    {
    }

    /// Computes one step of both, with the same number of substeps and the same dt within this share of it: by default
    /// dt follows the state, which differs by rounding.
    void advance(double share = 1e-9)
    {
        const solver::TimeStep one = alone.advance(), all = together.advance();
        ASSERT_EQ(one.substeps, all.substeps);
        ASSERT_NEAR(one.dt, all.dt, share * one.dt);
    }

    /// Bodies of the run on all ranks, on every rank. Collective.
    io::BodyFields bodies_together() { return io::gathered(world(), together.simulation().body_fields()); }

    /// Gives pages other owners, as a repartition does.
    template<class Owner>
    void give_pages(const Vec3<double>& size, Owner owner)
    {
        const OwnedPages pages = pages_of(lattice(), size, owner);
        decomposition_.owners.assign(pages.key, pages.rank);
    }

    /// Owning rank of a position.
    std::int32_t owner_of(const Vec3<double>& place) const
    {
        const auto& pages = decomposition_.owners;
        return decomp::PageOwnership(lattice(), pages.keys(), pages.ranks(), pages.sand()).owner_of(place);
    }

private:
    decomp::PageLattice lattice() const { return solver::page_lattice_of(built_); }

    static scene::Scene with(Owners owners, scene::Scene scene)
    {
        if (owners == Owners::stay) { scene.balance.threshold = std::numeric_limits<double>::infinity(); }
        scene.balance.least_load = 0; // scenes of tests are small
        return scene;
    }

    template<class Owner>
    decomp::Decomposition<Exec>* given(const Vec3<double>& size, Owner owner)
    {
        give_pages(size, owner);
        return &decomposition_;
    }

    world::World                built_;
    decomp::Decomposition<Exec> decomposition_;

public:
    Experiment<Exec> alone, together;
};

} // namespace tread::test
