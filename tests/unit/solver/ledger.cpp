#include "solver/ledger.hpp"

#include <gtest/gtest.h>

namespace
{

using namespace tread;

/// One step, in which contacts that hold nothing bring the kinetic energy of sand and of bodies from `before` to
/// `energy`, J.
solver::Ledger after_contact(double before, double energy)
{
    solver::Census start;
    start.sand.mass = start.rigid.mass = 1;
    start.sand.kinetic = start.rigid.kinetic = before;
    solver::Ledger ledger({0, 0, -9.81}, start);

    solver::SandReport sand;
    sand.last_points[mpm::point_kinetic] = energy;
    sand.grid[mpm::grid_kinetic_before]  = before;
    sand.grid[mpm::grid_kinetic_after]   = energy;
    sand.points[mpm::point_contact_work] = energy - before;
    solver::RigidReport rigid;
    rigid.sand_work = energy - before;
    ledger.steps(1e-3, 1, sand, rigid, {}, 2);

    solver::Census end = start;
    end.sand.kinetic = end.rigid.kinetic = energy;
    EXPECT_NEAR(ledger.energy(end).coupling, 2 * (before - energy), 1e-12);
    return ledger;
}

TEST(Ledger, BooksWhatContactsLose) { EXPECT_NEAR(after_contact(2, 1).errors().energy, 0, 1e-12); }

/// Energy that contacts make without a source is an error, not an entry: here 2 J, of which either side has 2.
TEST(Ledger, ShowsWhatContactsMake) { EXPECT_NEAR(after_contact(1, 2).errors().energy, 2.0 / 2.0, 1e-12); }

} // namespace
