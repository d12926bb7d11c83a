#include "decomp/grid_halo.hpp"

#include <map>

#include "backend.hpp"
#include "base/random.hpp"
#include "decomposition_options.hpp"
#include "kernels/mpm/transfers/scatter.hpp"
#include "mpi_session.hpp"

// Contributions of ranks to shared nodes, with border pages first and the others during the exchange, compared with a
// scatter of all pages whose contributions are gathered and added here.
namespace tread::decomp
{
namespace
{

const mpm::GridGeometry geometry{0.1, 0.5, Vec3<double>(24, 1, 1)};
const mpm::GridWalls    open_walls = {};

using Values = std::vector<double>;

template<class Exec>
class GridHalos : public test::BackendTest<Exec>
{
protected:
    /// Random points of this rank in a bar of 6 m along x; the next rank's bar begins 5.4 m further.
    mpm::Points<Exec, double> cloud(std::int64_t count)
    {
        Random     random(17 + static_cast<std::uint64_t>(test::world().rank()));
        const auto numbers = [&](std::int64_t n, double low, double high)
        {
            Values values(static_cast<std::size_t>(n));
            for (double& value : values) { value = random.uniform(low, high); }
            return values;
        };
        const double start    = 0.2 + 5.4 * test::world().rank();
        Values       position = numbers(count, start, start + 6), across = numbers(2 * count, 0.1, 0.9);
        position.insert(position.end(), across.begin(), across.end());
        mpm::Points<Exec, double> points(this->exec());
        points.allocate(count, {});
        points.position.assign(position);
        points.velocity.assign(numbers(3 * count, -1, 1));
        points.stress.assign(numbers(6 * count, -1e4, 1e4));
        points.mass.assign(numbers(count, 1, 2));
        points.volume.assign(numbers(count, 1e-4, 2e-4));
        points.volume_ratio.assign(numbers(count, 0.9, 1.1));
        return points;
    }

    static Values of_page(const Values& values, std::size_t page)
    {
        const auto first = values.begin() + static_cast<std::ptrdiff_t>(page * mpm::node_page_values);
        return {first, first + mpm::node_page_values};
    }

    /// Contributions of each rank to each of its node pages, in rank order; from complete tiles.
    std::map<std::uint64_t, std::vector<Values>> brought(const mpm::Pages<Exec>& pages, const double* tiles)
    {
        const std::vector<std::uint64_t> keys = pages.node_page_key.to_host();
        mpm::SharedPages<Exec, double>   all(this->exec());
        std::vector<std::int32_t>        every(keys.size());
        for (std::size_t i = 0; i < every.size(); ++i) { every[i] = static_cast<std::int32_t>(i); }
        all.page.assign(every);
        all.own.resize(all.page.size() * mpm::node_page_values);
        mpm::sum_own_parts(this->exec(), pages.view(geometry.spacing, geometry.stencil_shift), tiles, all);

        const std::vector<std::uint64_t>             page  = test::world().gather(keys);
        const Values                                 parts = test::world().gather(all.own.to_host());
        std::map<std::uint64_t, std::vector<Values>> found;
        for (std::size_t i = 0; i < page.size(); ++i) { found[page[i]].push_back(of_page(parts, i)); }
        return found;
    }
};
TYPED_TEST_SUITE(GridHalos, test::Backends, test::BackendNames);

Values sum(const std::vector<Values>& parts)
{
    Values total(mpm::node_page_values, 0.0);
    for (const Values& part : parts)
    {
        for (std::size_t v = 0; v < total.size(); ++v) { total[v] += part[v]; }
    }
    return total;
}

TYPED_TEST(GridHalos, GiveTheBitsOfAnExchangeAfterAllPages)
{
    Decomposition<TypeParam>             ranks(test::world(), this->exec(), test::decomposition_options());
    mpm::Points<TypeParam, double>       points = this->cloud(5000);
    mpm::Pages<TypeParam>                pages(this->exec());
    mpm::OrderScratch<TypeParam, double> scratch(this->exec());
    mpm::order_points(this->exec(), points, pages, geometry, scratch);
    GridHalo<TypeParam, double> halo(ranks);
    halo.plan(pages, open_walls);
    const mpm::PagesView     view = pages.view(geometry.spacing, geometry.stencil_shift);
    const std::int64_t       size = view.point_pages * mpm::node_channels * mpm::tile_nodes;
    Array<TypeParam, double> whole(this->exec(), "tiles", size), parted(this->exec(), "tiles", size);
    whole.fill_zero();
    parted.fill_zero();

    mpm::scatter(this->exec(), points.view(), view, mpm::all_point_pages(view), whole.data());
    const auto                       expected = this->brought(pages, whole.data());
    const std::vector<std::uint64_t> keys     = pages.node_page_key.to_host();
    for (int step = 0; step < 3; ++step) // as in a run: messages and lists are reused for many steps
    {
        halo.begin(view, parted.data(),
                   [&](const TypeParam& exec, const mpm::PageList& border)
                   { mpm::scatter(exec, points.view(), view, border, parted.data()); });
        mpm::scatter(this->exec(), points.view(), view, halo.interior(), parted.data());
        halo.finish();
        EXPECT_EQ(parted.to_host(), whole.to_host()) << "every page is scattered, once";

        const mpm::SharedPagesView<double> shared = halo.view();
        std::vector<std::int32_t>          number(keys.size());
        copy_to_host(this->exec(), number.data(), shared.number_of, number.size() * sizeof(number[0]));
        Values total(static_cast<std::size_t>(halo.pages() * mpm::node_page_values));
        copy_to_host(this->exec(), total.data(), shared.total, total.size() * sizeof(total[0]));
        std::int64_t pages_of_several = 0;
        for (std::size_t i = 0; i < keys.size(); ++i)
        {
            const std::vector<Values>& parts = expected.at(keys[i]);
            ASSERT_EQ(number[i] >= 0, parts.size() > 1) << "shared is what several ranks list";
            if (parts.size() == 1) { continue; }
            EXPECT_EQ(this->of_page(total, static_cast<std::size_t>(number[i])), sum(parts));
            ++pages_of_several;
        }
        EXPECT_EQ(pages_of_several, halo.pages());
    }
    const bool alone = test::world().size() == 1;
    EXPECT_EQ(halo.pages() > 0, !alone);
    EXPECT_GT(halo.interior().count, 0);
    EXPECT_EQ(halo.interior().count < view.point_pages, !alone);
}

} // namespace
} // namespace tread::decomp
