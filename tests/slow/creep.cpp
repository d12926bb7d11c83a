#include "../physics/lone_point.hpp"

namespace
{

using namespace tread;

template<class Exec>
class Creep : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Creep, test::Backends, test::BackendNames);

/// Precision of positions (design, section 4): 1 mm/s for a million steps at x = 900 m.
TYPED_TEST(Creep, AMillionStepsFarFromTheOriginInDouble) { test::creep<double>(this->exec(), "double", 1000000); }
TYPED_TEST(Creep, AMillionStepsFarFromTheOriginInSingle) { test::creep<float>(this->exec(), "single", 1000000); }

} // namespace
