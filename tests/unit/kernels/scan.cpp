#include <string>
#include <vector>

#include "backend.hpp"
#include "backend/reduce.hpp"
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

/// On a GPU many rows are shared by blocks; a signed zero must be the smallest value, not the largest.
TYPED_TEST(Scan, LargestOfManyRows)
{
    constexpr int       count = 10000, width = 3;
    std::vector<double> rows(static_cast<std::size_t>(count * width), -0.0);
    rows[7777 * width + 1] = 0.25;
    rows[9999 * width + 1] = 0.5;
    rows[1234 * width + 2] = -3;
    Array<TypeParam, double> values(this->exec(), "test rows"), largest(this->exec(), "test largest", width);
    values.assign(rows);
    largest_of_rows(this->exec(), values.data(), count, width, largest.data());
    EXPECT_EQ(largest.to_host(), (std::vector<double>{0, 0.5, 0}));
}

} // namespace
} // namespace tread::test
