#include "../physics/rock_rest.hpp"

// Piles of a hundred rocks of each kind and of all kinds (docs/verification.md#rocks-at-rest): damped, then left alone
// for 2 s.
namespace rock_piles_test
{

using namespace tread;

template<class Exec>
class RockPiles : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(RockPiles, test::Backends, test::BackendNames);

constexpr double damped_time = 1.2, free_time = 2.0;

/// `count` rocks of each of `kinds`, dropped into a bin of five by five rocks.
std::string pile(const test::RockForms& forms, const std::vector<std::string>& kinds, int count)
{
    const double height = 0.0035 * count; // solid fraction 0.24
    std::string  text =
        test::rock_domain({0.05, 0.05, height * double(kinds.size()) + 0.05}, 0,
                          "x = \"slip\", y = \"slip\", bottom = \"fixed\", top = \"open\"", "linear_overlap = 1e-2") +
        test::stone(1e7, 0.5, 0.5) + forms.text();
    double low = 0;
    for (const std::string& kind : kinds)
    {
        text += test::rocks_of(kind, count, "rain", {0, 0, low}, {0.05, 0.05, low + height});
        low += height;
    }
    return text + test::phase("settle", 0.3, damped_time) + test::phase("rest", 0, free_time);
}

template<class Exec>
void expect_pile_rests(const Exec& exec, const std::vector<std::string>& kinds, int count)
{
    const test::RockForms forms;
    test::expect_rest(exec, pile(forms, kinds, count), damped_time, free_time);
}

TYPED_TEST(RockPiles, BumpyRocksRest) { expect_pile_rests(this->exec(), {"bumpy"}, 100); }
TYPED_TEST(RockPiles, RoundedCubesRest) { expect_pile_rests(this->exec(), {"rounded"}, 100); }
TYPED_TEST(RockPiles, CubesRest) { expect_pile_rests(this->exec(), {"cube"}, 100); }
TYPED_TEST(RockPiles, AllKindsTogetherRest) { expect_pile_rests(this->exec(), {"bumpy", "rounded", "cube"}, 34); }

} // namespace rock_piles_test
