#include <algorithm>
#include <bit>
#include <vector>

#include "backend.hpp"
#include "kernels/mpm/pages/far_cells.hpp"
#include "kernels/mpm/pages/moves.hpp"

// Which cells of other ranks' pages are far from a rank's own ones, and what points that enter them ask for.
namespace tread::mpm
{
namespace far_cells_test
{

constexpr double       spacing = 0.1;
constexpr std::int32_t self    = 1;
constexpr Index3       home{5, 5, 5};

Vec3<double> centre_of(Index3 cell) { return {spacing * (cell.x + 1), spacing * (cell.y + 1), spacing * (cell.z + 1)}; }

/// Pages with a point in each of the 27 around `home`, the only one that this rank owns.
template<class Exec>
Pages<Exec> pages_around_home(const Exec& exec)
{
    std::vector<double> position[3];
    for (int direction = 0; direction < directions; ++direction)
    {
        const Vec3<double> x = centre_of(node_at(page_towards(home, direction), 21));
        for (int c = 0; c < 3; ++c) { position[c].push_back(x[c]); }
    }
    Points<Exec, double> points(exec);
    points.allocate(directions, {});
    std::vector<double> all(static_cast<std::size_t>(3 * points.stride));
    for (std::size_t c = 0; c < 3; ++c)
    {
        std::copy(position[c].begin(), position[c].end(), all.begin() + std::ptrdiff_t(c) * points.stride);
    }
    points.position.assign(all);
    Pages<Exec>                pages(exec);
    OrderScratch<Exec, double> scratch(exec);
    EXPECT_EQ(order_points(exec, points, pages, {spacing, 0.5, {6.0, 6.0, 6.0}}, scratch), 0);

    Array<Exec, std::uint64_t> key(exec, "owned pages");
    Array<Exec, std::int32_t>  owner(exec, "owners");
    key.assign({page_key(home)});
    owner.assign({self});
    mark_far_cells(exec, pages, {1, key.data(), owner.data()}, self);
    return pages;
}

std::int64_t row_of(const std::vector<std::uint64_t>& keys, Index3 page)
{
    return std::lower_bound(keys.begin(), keys.end(), page_key(page)) - keys.begin();
}

template<class Exec>
class FarCells : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(FarCells, test::Backends, test::BackendNames);

TYPED_TEST(FarCells, AllButTheLayerAtAFaceOfAnOwnPage)
{
    const Pages<TypeParam>           pages = pages_around_home(this->exec());
    const std::vector<std::uint64_t> keys = pages.point_page_key.to_host(), far = pages.far_cells.to_host();
    ASSERT_EQ(far.size(), keys.size());
    for (int direction = 0; direction < directions; ++direction)
    {
        const Index3        page  = page_towards(home, direction);
        const std::uint64_t cells = far[static_cast<std::size_t>(row_of(keys, page))];
        const int           axes = (page.x != home.x ? 1 : 0) + (page.y != home.y ? 1 : 0) + (page.z != home.z ? 1 : 0);
        const int           expected = axes == 0 ? 0 : axes == 1 ? page_cells - page_edge * page_edge : page_cells;
        EXPECT_EQ(std::popcount(cells), expected) << "direction " << direction;
        if (axes != 1) { continue; }
        for (int place = 0; place < page_cells; ++place)
        {
            const Index3 cell   = node_at(page, place);
            const int    beyond = std::max({home.x * 4 - cell.x, cell.x - home.x * 4 - 3, home.y * 4 - cell.y,
                                            cell.y - home.y * 4 - 3, home.z * 4 - cell.z, cell.z - home.z * 4 - 3});
            EXPECT_EQ(cells >> place & 1, beyond > 1 ? 1U : 0U) << "direction " << direction << ", cell " << place;
        }
    }
}

class FarCellsOnTheHost : public test::BackendTest<Cpu>
{
};

/// A point goes from the last layer of its rank's page through the layers of the next one.
TEST_F(FarCellsOnTheHost, APointThatEntersOneAsksForASort)
{
    Pages<Cpu>      pages = pages_around_home(this->exec());
    const PagesView view  = pages.view(spacing, 0.5);
    const auto      keys  = pages.point_page_key.to_host();
    const Index3    inner = node_at(home, place_in_page({3, 1, 1}));
    const auto      to    = [&](std::int64_t page, Index3 from, int layers) {
        return move_to(view, page, from, centre_of({inner.x + layers, inner.y, inner.z})).cell_change;
    };
    const Index3 next{inner.x + 1, inner.y, inner.z};
    EXPECT_EQ(to(row_of(keys, home), inner, 0), CellChange::none);
    EXPECT_EQ(to(row_of(keys, home), inner, 1), CellChange::moved) << "the layer beside the page";
    EXPECT_EQ(to(row_of(keys, page_of(next)), next, 2), CellChange::rim) << "the second layer";
    EXPECT_EQ(to(row_of(keys, page_of(next)), next, 0), CellChange::moved) << "back";

    pages.far_cells.resize(0);
    const PagesView alone = pages.view(spacing, 0.5);
    EXPECT_EQ(alone.far_cells, nullptr);
    EXPECT_EQ(move_to(alone, row_of(keys, page_of(next)), next, centre_of({next.x + 1, next.y, next.z})).cell_change,
              CellChange::moved)
        << "on one rank nothing is far";
}

} // namespace far_cells_test
} // namespace tread::mpm
