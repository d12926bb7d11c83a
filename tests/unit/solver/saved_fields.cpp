#include <cstring>
#include <iterator>
#include <numeric>
#include <string>

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "io/checkpoint_file.hpp"
#include "mpi_session.hpp"
#include "solver/ledger/energy_watch.hpp"
#include "solver/ledger/extremes.hpp"
#include "solver/ledger/ledger.hpp"
#include "solver/state_file.hpp"
#include "temporary_directory.hpp"

// Parts of a state that are saved field by field: no field is forgotten, and none is loaded out of its bounds.
namespace
{

using namespace tread;
using namespace tread::solver;

/// A checkpoint with one part of a state, in a directory of its own.
class Saved
{
public:
    template<class Part>
    explicit Saved(const Part& part)
    {
        Part                 copy = part;
        io::CheckpointWriter writer(self_, path());
        StateFile            file(self_, writer, Fidelity::exact);
        copy.transfer(file);
        writer.finish();
    }

    template<class Part>
    void load(Part& part) const
    {
        const io::CheckpointReader reader(path());
        StateFile                  file(self_, reader, Fidelity::exact);
        part.transfer(file);
    }

private:
    std::string path() const { return directory_.path("part.h5"); }

    test::TemporaryDirectory directory_;
    Communicator             self_{MPI_COMM_SELF};
};

/// Compares all members; these parts hold doubles only, without padding.
template<class Part>
bool same_bits(const Part& a, const Part& b)
{
    static_assert(sizeof(Part) % sizeof(double) == 0);
    return std::memcmp(static_cast<const void*>(&a), static_cast<const void*>(&b), sizeof(Part)) == 0;
}

/// Saves a part, loads it into another, and compares.
template<class Part>
void expect_all_saved(const Part& saved, Part other)
{
    ASSERT_FALSE(same_bits(saved, other)) << "a test of nothing";
    Saved(saved).load(other);
    EXPECT_TRUE(same_bits(saved, other)) << "a member is not saved";
}

template<class Part>
void expect_refused(const Part& saved, Part other, const std::string& data_set)
{
    try
    {
        Saved(saved).load(other);
        FAIL() << data_set;
    }
    catch (const EnvironmentError& error)
    {
        EXPECT_NE(std::string(error.what()).find(data_set), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("accepted: a number from 0 to"), std::string::npos) << error.what();
    }
}

/// A report in which no two numbers are equal.
SandReport report()
{
    SandReport report;
    report.steps  = 3;
    double number = 1;
    for (double* sums : {report.grid, report.last_grid})
    {
        for (int i = 0; i < mpm::grid_sums; ++i) { sums[i] = number += 0.25; }
    }
    for (double* sums : {report.points, report.last_points})
    {
        for (int i = 0; i < mpm::point_sums; ++i) { sums[i] = number += 0.25; }
    }
    return report;
}

Census census(double unit)
{
    Census census;
    census.sand         = {unit, 2 * unit, 3 * unit, {unit, 5 * unit, 0.1 * unit}, {7 * unit, unit, 9 * unit}};
    census.rigid        = {unit, 11 * unit, 12 * unit, 13 * unit, {14 * unit, 0.2 * unit, 16 * unit}};
    census.sand_contact = 17 * unit;
    return census;
}

/// A ledger after steps of `dt` (s) in which everything happened.
Ledger busy_ledger(double dt)
{
    RigidReport bodies;
    bodies.friction     = 0.31;
    bodies.restitution  = 0.32;
    bodies.damped       = 0.33;
    bodies.driver_work  = 0.34;
    bodies.sand_work    = 0.35;
    bodies.weight_power = 0.36;
    bodies.wall_impulse = {0.37, 0.38, 0.39};
    bodies.substep      = 1e-4;
    Ledger ledger({0, 0.1, -9.81}, census(1));
    ledger.steps(dt, 3, report(), bodies, {0.41, 0.42}, 2);
    ledger.energy(census(1.5));
    ledger.balance(census(1.25));
    return ledger;
}

TEST(SavedFields, HoldAllOfTheLedger) { expect_all_saved(busy_ledger(1e-3), Ledger({0, 0.1, -9.81}, census(0.5))); }

TEST(SavedFields, HoldAllOfTheExtremes)
{
    expect_all_saved(Extremes{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8}, Extremes{});
}

TEST(SavedFields, HoldAllOfTheWatchOfEnergy)
{
    EnergyWatch watch(1, 10);
    watch.add(report(), 1e-4);
    watch.add(report(), 2e-4);
    expect_all_saved(watch, EnergyWatch(2, 20));
}

TEST(SavedFields, AreRefusedByNameOutOfTheirBounds)
{
    expect_refused(busy_ledger(-1e-3), Ledger({0, 0.1, -9.81}, census(0.5)), "ledger/time");
    Extremes wrong;
    wrong.touching = -1;
    expect_refused(wrong, Extremes{}, "extremes/touching");
    expect_refused(EnergyWatch(-1, 10), EnergyWatch(1, 10), "energy_watch/floor");
}

} // namespace
