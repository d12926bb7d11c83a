#include "../physics/head_on.hpp"

namespace
{

using namespace tread;

template<class Exec>
class HeadOnAtSize : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(HeadOnAtSize, test::Backends, test::BackendNames);

/// The paper's 3.1 at its own size, 33,552 points. Single precision accumulates rounding over 2,000 steps: momentum is
/// within sqrt(steps x points per contact) of 6e-8.
TYPED_TEST(HeadOnAtSize, OnePointACell)
{
    const auto found = test::collide<TypeParam, float>(this->exec(), "../configs/paper/head_on_1.toml", {});
    test::expect_catalogue(found, ", 1 a cell", 1e-5);
}

/// 268,096 points.
TYPED_TEST(HeadOnAtSize, EightPointsACell)
{
    const auto found = test::collide<TypeParam, float>(this->exec(), "../configs/paper/head_on_8.toml", {});
    test::expect_catalogue(found, ", 8 a cell", 1e-5);
}

} // namespace
