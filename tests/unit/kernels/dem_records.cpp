#include <vector>

#include "dem_scene.hpp"
#include "kernels/dem/pairs/records.hpp"

// Contact records that leave a rank with their bodies, and come back.
namespace tread::test
{
namespace
{

template<class Exec>
class DemRecords : public DemTest<Exec>
{
};
TYPED_TEST_SUITE(DemRecords, Backends, BackendNames);

dem::Patch stiff(double stiffness)
{
    dem::Patch patch = dem::no_patch();
    patch.stiffness  = stiffness;
    return patch;
}

std::vector<double> stiffnesses(const std::vector<dem::Patch>& patches)
{
    std::vector<double> found;
    for (const dem::Patch& patch : patches) { found.push_back(patch.stiffness); }
    return found;
}

/// Four bodies, the third large, and a wall, number 4. Pairs with the large body and walls go with the other side, all
/// others with the second body.
TYPED_TEST(DemRecords, LeaveWithTheBodyThatDecidesAndComeBack)
{
    std::vector<Solid> solids;
    for (int i = 0; i < 4; ++i) { solids.push_back(solid_sphere(0.1, 2000, {0.3 * i, 0, 0})); }
    SolidScene<TypeParam>            scene(this->exec(), {exact_sphere()}, solids, {});
    dem::Pairs<TypeParam>&           pairs = scene.pairs;
    const std::vector<std::uint64_t> all{dem::pair_key(0, 1), dem::pair_key(0, 2), dem::pair_key(0, 4),
                                         dem::pair_key(1, 2), dem::pair_key(1, 3), dem::pair_key(3, 4)};
    std::vector<dem::Patch>          patches;
    std::vector<Vec3<double>>        places;
    for (std::size_t p = 0; p < all.size(); ++p)
    {
        patches.push_back(stiff(static_cast<double>(p)));
        places.emplace_back(0, 0, static_cast<double>(p));
    }
    pairs.sizes.is_large.assign({0, 0, 1, 0});
    pairs.last.key.assign(all);
    pairs.last.patch.assign(patches);
    pairs.patches.last_place.assign(places);

    Array<TypeParam, std::int32_t> leaving(this->exec(), "leaving");
    leaving.assign({-1, 0, -1, -1});
    const auto taken = dem::take_records(this->exec(), pairs, leaving);
    EXPECT_EQ(taken.key.to_host(), (std::vector<std::uint64_t>{dem::pair_key(0, 1), dem::pair_key(1, 2)}));
    EXPECT_EQ(stiffnesses(taken.patch.to_host()), (std::vector<double>{0, 3}));
    EXPECT_EQ(taken.place.to_host(), (std::vector<Vec3<double>>{{0, 0, 0}, {0, 0, 3}}));
    EXPECT_EQ(pairs.last.key.to_host(), (std::vector<std::uint64_t>{dem::pair_key(0, 2), dem::pair_key(0, 4),
                                                                    dem::pair_key(1, 3), dem::pair_key(3, 4)}));
    EXPECT_EQ(stiffnesses(pairs.last.patch.to_host()), (std::vector<double>{1, 2, 4, 5}));

    dem::add_records(this->exec(), pairs, taken);
    EXPECT_EQ(pairs.last.key.to_host(), all);
    EXPECT_EQ(stiffnesses(pairs.last.patch.to_host()), stiffnesses(patches));
    EXPECT_EQ(pairs.patches.last_place.to_host(), places);

    leaving.assign({-1, -1, 0, -1});
    EXPECT_EQ(dem::take_records(this->exec(), pairs, leaving).key.size(), 0) << "a large body decides over none";
    EXPECT_EQ(pairs.last.key.to_host(), all);
}

/// The second of four bodies has gone, one has come before the last; the wall follows them.
TYPED_TEST(DemRecords, FollowTheRowsOfTheirBodies)
{
    SolidScene<TypeParam>  scene(this->exec(), {exact_sphere()}, {solid_sphere(0.1, 2000, {0, 0, 0})}, {});
    dem::Pairs<TypeParam>& pairs = scene.pairs;
    pairs.last.key.assign({dem::pair_key(0, 1), dem::pair_key(0, 2) + 1, dem::pair_key(0, 4), dem::pair_key(1, 3),
                           dem::pair_key(2, 3), dem::pair_key(3, 4)});
    pairs.last.patch.assign({stiff(0), stiff(1), stiff(2), stiff(3), stiff(4), stiff(5)});
    Array<TypeParam, std::int32_t> row(this->exec(), "rows");
    row.assign({0, -1, 1, 3});
    dem::renumber_records(this->exec(), pairs, row, 4);
    EXPECT_EQ(pairs.last.key.to_host(), (std::vector<std::uint64_t>{dem::pair_key(0, 1) + 1, dem::pair_key(0, 4),
                                                                    dem::pair_key(1, 3), dem::pair_key(3, 4)}));
    EXPECT_EQ(stiffnesses(pairs.last.patch.to_host()), (std::vector<double>{1, 2, 4, 5}));
}

/// Where nobody here has several patches, and some that arrive do.
TYPED_TEST(DemRecords, PlacesThatAreMissingAreZero)
{
    SolidScene<TypeParam>  scene(this->exec(), {exact_sphere()}, {solid_sphere(0.1, 2000, {0, 0, 0})}, {});
    dem::Pairs<TypeParam>& pairs = scene.pairs;
    pairs.last.key.assign({dem::pair_key(0, 5)});
    pairs.last.patch.assign({stiff(1)});
    dem::RecordRows<TypeParam> rows(this->exec());
    rows.key.assign({dem::pair_key(0, 3)});
    rows.patch.assign({stiff(2)});
    rows.place.assign({Vec3<double>(1, 2, 3)});
    dem::add_records(this->exec(), pairs, rows);
    EXPECT_EQ(pairs.last.key.to_host(), (std::vector<std::uint64_t>{dem::pair_key(0, 3), dem::pair_key(0, 5)}));
    EXPECT_EQ(pairs.patches.last_place.to_host(), (std::vector<Vec3<double>>{{1, 2, 3}, {0, 0, 0}}));
}

} // namespace
} // namespace tread::test
