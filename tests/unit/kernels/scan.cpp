#include <string>
#include <vector>

#include "backend.hpp"
#include "backend/sort.hpp"
#include "base/errors.hpp"

namespace tread::test
{
namespace
{

template<class Exec>
class Scan : public BackendTest<Exec>
{
};
TYPED_TEST_SUITE(Scan, Backends, BackendNames);

TYPED_TEST(Scan, SumOverInt32IsNamed)
{
    Array<TypeParam, std::int32_t> counts(this->exec(), "test counts");
    SortScratch<TypeParam>         scratch(this->exec());
    counts.assign({2000000000, 147483647, 0});
    EXPECT_EQ(exclusive_scan(this->exec(), counts, scratch), 2147483647);
    counts.assign({2000000000, 1500000000, 0});
    try
    {
        exclusive_scan(this->exec(), counts, scratch);
        FAIL() << "went on";
    }
    catch (const NumericalError& error)
    {
        EXPECT_NE(std::string(error.what()).find("3500000000"), std::string::npos) << error.what();
    }
}

} // namespace
} // namespace tread::test
