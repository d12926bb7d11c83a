#include <cmath>
#include <map>

#include <fmt/format.h>

#include "harness.hpp"

// Shear band in dense sand that softens, with and without a softening length, at two spacings.
namespace
{

using namespace tread;

template<class Exec>
class FullSizeShearBand : public test::BackendTest<Exec>
{
};
TYPED_TEST_SUITE(FullSizeShearBand, test::Backends, test::BackendNames);

constexpr double width = 0.06, speed = 0.1, duration = 0.12;

/// Biaxial compression of moist dense sand between smooth plates, free at its sides; a corner is weaker. `softening`:
/// keys of both sands.
std::string compression_text(double h, const std::string& softening)
{
    const auto sand = [&](const char* name, double relative_density)
    {
        return fmt::format(R"(
[[material]]
name               = "{}"
model              = "bolton"
density            = 1600.0
young              = 5.0e6
poisson            = 0.3
friction_angle_deg = 32.0
cohesion           = 1.0e4
relative_density   = {}
void_ratio_min     = 0.5
void_ratio_max     = 0.85
bolton_fit         = "plane-strain"
{}
)",
                           name, relative_density, softening);
    };
    return sand("dense", 0.8) + sand("weaker", 0.6) +
           fmt::format(R"(
[domain]
size    = [0.26, {h}, 0.16]
gravity = [0.0, 0.0, 0.0]
walls   = {{ x = "open", y = "slip", bottom = "slip", top = "open" }}
[grid]
spacing = {h}
[numerics]
precision    = "double"
point_radius = "semi-domain"
[[material]]
name  = "steel"
model = "rigid"
young = 7.0e10
[[contact]]
between  = ["steel", "dense"]
friction = 0.0
[[shape]]
name     = "plate"
generate = {{ kind = "box", size = [0.12, {plate}, 0.02] }}
[[terrain]]
material = "dense"
region   = {{ box = [[0.1, 0.0, 0.0], [0.16, {h}, 0.02]] }}
[[terrain]]
material = "weaker"
region   = {{ box = [[0.1, 0.0, 0.02], [0.12, {h}, 0.04]] }}
[[terrain]]
material = "dense"
region   = {{ box = [[0.12, 0.0, 0.02], [0.16, {h}, 0.04]] }}
[[terrain]]
material = "dense"
region   = {{ box = [[0.1, 0.0, 0.04], [0.16, {h}, 0.12]] }}
[[body]]
name     = "top"
shape    = "plate"
material = "steel"
mass     = 1.0
position = [0.13, {middle}, 0.13001]
[[phase]]
name     = "shorten"
duration = {duration}
[[phase.motion]]
body  = "top"
x     = "held"
y     = "held"
z     = {{ velocity = -{speed}, ramp = 0.02 }}
roll  = "held"
pitch = "held"
yaw   = "held"
)",
                       fmt::arg("h", h), fmt::arg("plate", 0.96 * h), fmt::arg("middle", 0.5 * h),
                       fmt::arg("speed", speed), fmt::arg("duration", duration));
}

/// What a sample did.
struct Sample
{
    double band; ///< share of the sand that shears in the second half of the shortening
    double peak; ///< Pa, largest load over the area at the start
    double last; ///< Pa, mean over the last tenth
};

/// Returns plastic shear by point id.
template<class Simulation>
std::map<std::uint32_t, double> shear_of(Simulation& simulation)
{
    auto&                           points = simulation.sand().points();
    const auto                      id     = points.id.to_host();
    const auto                      shear  = points.plastic_shear.to_host();
    std::map<std::uint32_t, double> by_id;
    for (std::size_t i = 0; i < id.size(); ++i) { by_id[id[i]] = shear[i]; }
    return by_id;
}

/// Computes (sum g)^2 / (N sum g^2), the share of the points over which an increment g of shear is spread.
double spread(const std::map<std::uint32_t, double>& before, const std::map<std::uint32_t, double>& after)
{
    double sum = 0, squares = 0;
    for (const auto& [id, shear] : after)
    {
        const double grown = shear - before.at(id);
        sum += grown;
        squares += grown * grown;
    }
    return sum * sum / (squares * static_cast<double>(after.size()));
}

template<class Exec>
Sample compress(const Exec& exec, double h, const std::string& softening)
{
    test::Experiment<Exec>          sample(exec, compression_text(h, softening));
    std::map<std::uint32_t, double> middle;
    Sample                          result{0, 0, 0};
    double                          part = 0.1 * duration;
    sample.simulation().begin_mean();
    sample.run(
        [&](double time)
        {
            if (middle.empty() && time >= 0.5 * duration) { middle = shear_of(sample.simulation()); }
            if (time < part - 1e-9) { return; }
            result.last = sample.simulation().named_bodies().at(0).force[2] / (width * h);
            result.peak = std::max(result.peak, result.last);
            sample.simulation().begin_mean();
            part += 0.1 * duration;
        });
    result.band = spread(middle, shear_of(sample.simulation()));
    return result;
}

/// Without a length the band is as thick as cells, so that cells half as wide halve the sheared share. With a length of
/// 10 mm, one coarse cell, it stays. What is left is the grid's own width, which adds to the length's: a variance of
/// some h^2/4 per transfer.
TYPED_TEST(FullSizeShearBand, HasTheThicknessOfTheSofteningLength)
{
    const auto ratio = [&](const char* what, const std::string& softening)
    {
        const Sample coarse = compress(this->exec(), 0.01, softening), fine = compress(this->exec(), 0.005, softening);
        for (const Sample& sample : {coarse, fine})
        {
            std::printf("  %s: sheared share %.3f, peak %.1f kPa, at the end %.1f kPa\n", what, sample.band,
                        1e-3 * sample.peak, 1e-3 * sample.last);
        }
        return fine.band / coarse.band;
    };
    const double kept = ratio("length of 10 mm", "softening_length = 0.01"), lost = ratio("no length", "");
    test::report("sheared share with 5 mm over that with 10 mm, length of 10 mm", kept, 1, 0.2, "the grid's own width");
    EXPECT_NEAR(kept, 1, 0.2);
    test::report("the same without a length", lost, 0.5, 0.15, "halved, or a little less: the spot keeps its size");
    EXPECT_NEAR(lost, 0.5, 0.15);
}

} // namespace
