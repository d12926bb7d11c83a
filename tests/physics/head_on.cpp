#include "head_on.hpp"

namespace
{

using namespace tread;

template<class Exec>
class HeadOn : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(HeadOn, test::Backends, test::BackendNames);

/// The paper's 3.1 with cells of twice its size, 8 points in each. At its own size: tests/slow.
TYPED_TEST(HeadOn, SpheresExchangeTheirVelocities)
{
    const auto found = test::collide<TypeParam, double>(
        this->exec(), "../configs/paper/head_on_8.toml",
        {"grid.spacing=0.02", "numerics.precision=\"double\"", "domain.size=[1.4, 0.6, 0.6]", "shape[0].sdf_cells=64",
         "terrain[0].region.sphere.centre=[0.94, 0.3, 0.3]", "body[0].position=[0.44, 0.3, 0.3]"});
    test::expect_catalogue(found, ", h = 0.02 m, 8 a cell", 1e-9);
}

} // namespace
