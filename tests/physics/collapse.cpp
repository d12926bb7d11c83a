#include "collapse.hpp"

namespace
{

using namespace tread;

template<class Exec>
class Collapse : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Collapse, test::Backends, test::BackendNames);

/// One column on a coarse grid; the slow tests have three aspect ratios on finer ones, and their slopes.
TYPED_TEST(Collapse, RunsOutAsFarAsSandDoes)
{
    const test::CollapseSetup setup{1.1, 12};
    test::check_deposit(setup, test::collapse(this->exec(), setup));
}

} // namespace
