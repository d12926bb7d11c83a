#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "backend.hpp"
#include "kernels/mpm/pages/order.hpp"
#include "kernels/mpm/transfers/mean_strain.hpp"

// Nonlocal mean strain of points: moments of the weights, fields that must be kept, and gaps that nothing may cross.
namespace mpm_mean_strain_test
{

using namespace tread;
using namespace tread::mpm;

constexpr double spacing = 0.1, size = 2.6;

/// Number of cells along each axis; cells of quadratic splines lie around nodes, from half a spacing on.
constexpr int cells = 24;

using Field = std::function<double(const Vec3<double>&)>;

template<class Exec>
struct Sand
{
    explicit Sand(const Exec& exec)
        : points(exec)
        , pages(exec)
        , scratch(exec)
        , materials(exec, "materials")
    {
        const auto elasticity = make_elasticity<double>(1e7, 0.3, 1600);
        materials.assign({make_material(elasticity, make_bolton<double>({33, 0, 0}, {0.8, 0.6, 1, 10, 1, 3, 2})),
                          make_material(elasticity, make_bolton<double>({33, 0, 0}, {0.8, 0.6, 1}))});
    }

    Points<Exec, double>                    points;
    Pages<Exec>                             pages;
    OrderScratch<Exec, double>              scratch;
    Array<Exec, MaterialParameters<double>> materials;
};

template<class Exec>
class MeanStrainTest : public test::BackendTest<Exec>
{
protected:
    /// Two points a cell and axis, of one mass, in the cells along x for which `kept` holds.
    void fill(const std::function<bool(int)>& kept = [](int) { return true; })
    {
        sand_.emplace(this->exec());
        std::vector<double> x, y, z;
        for (int k = 0; k < 2 * cells; ++k)
        {
            for (int j = 0; j < 2 * cells; ++j)
            {
                for (int i = 0; i < 2 * cells; ++i)
                {
                    if (!kept(i / 2)) { continue; }
                    x.push_back(spacing * (0.75 + 0.5 * i));
                    y.push_back(spacing * (0.75 + 0.5 * j));
                    z.push_back(spacing * (0.75 + 0.5 * k));
                }
            }
        }
        std::vector<double> all(x);
        all.insert(all.end(), y.begin(), y.end());
        all.insert(all.end(), z.begin(), z.end());
        sand_->points.allocate(static_cast<std::int64_t>(x.size()), {false, true, false, false, true});
        sand_->points.position.assign(all);
        sand_->points.mass.assign(std::vector<double>(x.size(), 0.7));
        order_points(this->exec(), sand_->points, sand_->pages, {spacing, 0.5, {size, size, size}}, sand_->scratch);
    }

    /// Sets the log volume ratio of every point and computes the means.
    void average(double length, const Field& strain)
    {
        std::vector<double> ratio;
        for (std::int64_t i = 0; i < sand_->points.count; ++i) { ratio.push_back(std::exp(strain(place(i)))); }
        sand_->points.volume_ratio.assign(ratio);
        MeanStrain<Exec, double> means(this->exec(), make_smoothing(length));
        const PagesView          view = sand_->pages.view(spacing, 0.5);
        means.resize(view.point_pages * page_cells);
        average_strain(this->exec(), sand_->points.view(), view, sand_->materials.data(), means);
        mean_ = sand_->points.mean_strain.to_host();
    }

    Vec3<double> place(std::int64_t i)
    {
        if (position_.empty()) { position_ = sand_->points.position.to_host(); }
        const auto at = static_cast<std::size_t>(i), s = static_cast<std::size_t>(sand_->points.stride);
        return {position_[at], position_[s + at], position_[2 * s + at]};
    }

    double mean(std::int64_t i) const { return mean_[static_cast<std::size_t>(i)]; }

    std::optional<Sand<Exec>> sand_;
    std::vector<double>       position_, mean_;
};
TYPED_TEST_SUITE(MeanStrainTest, test::Backends, test::BackendNames);

void expect_moment(const char* what, double measured, double expected, double tolerance, const char* why)
{
    std::printf("  %-34s measured %.12g expected %.12g tolerance %.1g (%s)\n", what, measured, expected, tolerance,
                why);
    EXPECT_NEAR(measured, expected, tolerance) << what;
}

/// The strain of one cell spreads over others. Its points lie a quarter of a cell from its centre, which is a part of
/// the variance between a point and those that see it.
TYPED_TEST(MeanStrainTest, WeightsHaveTheLengthForStandardDeviation)
{
    this->fill();
    const double       at = spacing * (cells / 2 + 1);
    const Vec3<double> centre(at, at, at);
    for (const double length : {1.0, 1.3, 1.6})
    {
        this->average(length, [&](const Vec3<double>& x)
                      { return (x - centre).cwiseAbs().maxCoeff() < 0.5 * spacing ? 1.0 : 0.0; });
        double       sum = 0, least = 0;
        Vec3<double> first = Vec3<double>::Zero(), second = first;
        for (std::int64_t i = 0; i < this->sand_->points.count; ++i)
        {
            const Vec3<double> off = (this->place(i) - centre) / spacing;
            const double       w   = this->mean(i) / 8;
            sum += w;
            least = std::min(least, w);
            first += w * off;
            second += w * off.cwiseProduct(off);
        }
        std::printf("length %.1f cells, %d passes\n", length, make_smoothing(length).passes);
        expect_moment("sum of weights", sum, 1, 1e-12, "rounding");
        expect_moment("least weight", least, 0, 0, "no negative weight");
        for (int c = 0; c < 3; ++c)
        {
            expect_moment("first moment, cells", first[c], 0, 1e-10, "symmetry, to rounding");
            expect_moment("second moment, cells^2", second[c] + 1.0 / 16, length * length, 1e-10, "rounding");
        }
    }
}

/// Masses differ, so that all sums round.
TYPED_TEST(MeanStrainTest, AConstantIsKeptExactly)
{
    this->fill([](int i) { return i % 5 != 2; });
    std::vector<double> mass;
    for (std::int64_t i = 0; i < this->sand_->points.count; ++i)
    {
        mass.push_back(0.1 + static_cast<double>(i % 7) / 3);
    }
    this->sand_->points.mass.assign(mass);
    const double ratio = std::exp(-0.0123);
    this->average(2, [](const Vec3<double>&) { return -0.0123; });
    std::int64_t wrong = 0;
    for (std::int64_t i = 0; i < this->sand_->points.count; ++i) { wrong += this->mean(i) == this->mean(0) ? 0 : 1; }
    EXPECT_EQ(wrong, 0);
    expect_moment("mean of a constant", this->mean(0), std::log(ratio), 2e-18, "the logarithm of another library");
}

/// A linear field is kept where no free surface is within the passes and the interpolation.
TYPED_TEST(MeanStrainTest, ALinearFieldIsKept)
{
    this->fill();
    const Vec3<double> slope(0.1, -0.05, 0.02);
    this->average(1.5, [&](const Vec3<double>& x) { return slope.dot(x); });
    const double reach = (make_smoothing(1.5).passes + 1.5) * spacing, low = 0.5 * spacing + reach,
                 high  = (cells + 0.5) * spacing - reach;
    double       worst = 0;
    std::int64_t inner = 0;
    for (std::int64_t i = 0; i < this->sand_->points.count; ++i)
    {
        const Vec3<double> x = this->place(i);
        if (x.minCoeff() < low || x.maxCoeff() > high) { continue; }
        worst = std::max(worst, std::abs(this->mean(i) - slope.dot(x)));
        ++inner;
    }
    EXPECT_GE(inner, 1000);
    expect_moment("error of a linear field", worst, 0, 1e-15, "rounding of 0.1");
}

/// Sand beside an empty layer of cells, within the length of other sand.
TYPED_TEST(MeanStrainTest, NothingCrossesAGap)
{
    this->fill([](int i) { return i != 10; });
    const double gap = spacing * 11;
    this->average(3, [&](const Vec3<double>& x) { return x[0] < gap ? 0.0 : 0.02; });
    double worst = 0;
    for (std::int64_t i = 0; i < this->sand_->points.count; ++i)
    {
        const double own = this->place(i)[0] < gap ? 0.0 : std::log(std::exp(0.02));
        worst            = std::max(worst, std::abs(this->mean(i) - own));
    }
    expect_moment("strain from beyond the gap", worst, 0, 1e-17, "the logarithm of another library");
}

/// Points of a material without a length give nothing to the mean, and get none.
TYPED_TEST(MeanStrainTest, OtherMaterialsTakeNoPart)
{
    this->fill();
    std::vector<std::uint8_t> material;
    for (std::int64_t i = 0; i < this->sand_->points.count; ++i)
    {
        material.push_back(this->place(i)[2] < 1.25 ? 1 : 0);
    }
    this->sand_->points.material.assign(material);
    this->average(2, [&](const Vec3<double>& x) { return x[2] < 1.25 ? 0.02 : 0.0; });
    double largest = 0;
    for (std::int64_t i = 0; i < this->sand_->points.count; ++i)
    {
        largest = std::max(largest, std::abs(this->mean(i)));
    }
    expect_moment("strain from another material", largest, 0, 0, "nothing is added");
}

TEST(Smoothing, PassesAreStableAndSeldomEnough)
{
    for (const double length : {1.0, 1.3, 3.0, 10.0})
    {
        const Smoothing how = make_smoothing(length);
        EXPECT_LE(how.share, 0.125) << "an own weight of a quarter";
        EXPECT_NEAR(2 * how.share * how.passes + 0.25, length * length, 1e-12 * length * length);
        EXPECT_LE(static_cast<double>(how.interval), length) << "a wave must not cross the length";
        EXPECT_GE(how.interval, 1);
    }
}

} // namespace mpm_mean_strain_test
