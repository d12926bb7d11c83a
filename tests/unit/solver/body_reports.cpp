#include <vector>

#include <gtest/gtest.h>

#include "backend.hpp"
#include "solver/bodies/body_reports.hpp"
#include "solver/ranks/body_ranks.hpp"

// Totals of bodies whose rows change.
namespace
{

using namespace tread;

template<class Exec>
class BodyReportsOfRows : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(BodyReportsOfRows, test::Backends, test::BackendNames);

/// The second of three bodies goes, and another comes before the third; the last row is of those that have gone.
TYPED_TEST(BodyReportsOfRows, BodiesThatComeHaveNoTotalsAndThoseThatGoLeaveThem)
{
    solver::BodyReports<TypeParam> reports(this->exec(), 4);
    std::vector<dem::BodyTotal>    totals = reports.totals.to_host();
    for (std::size_t row = 0; row < totals.size(); ++row) { totals[row].friction = 1.0 + static_cast<double>(row); }
    totals[1].wall_impulse = {1, 2, 3};
    reports.totals.assign(totals);

    solver::RowMoves<TypeParam> moves(this->exec());
    moves.from.assign({0, 0, 2});
    moves.to.assign({0, -1, 2});
    moves.gone = {1};
    moves.come = {1};
    reports.follow(moves);

    const std::vector<dem::BodyTotal> now = reports.totals.to_host();
    std::vector<double>               friction;
    for (const dem::BodyTotal& total : now) { friction.push_back(total.friction); }
    EXPECT_EQ(friction, (std::vector<double>{1, 0, 3, 4 + 2}));
    EXPECT_EQ(now.back().wall_impulse, Vec3<double>(1, 2, 3));
    EXPECT_EQ(now[1].wall_impulse, Vec3<double>(0, 0, 0));
}

} // namespace
