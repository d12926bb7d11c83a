#include <gmock/gmock.h>

#include "shape/generators/generators.hpp"
#include "unit/shape/meshes.hpp"

// Parameters of wheels that do not fit together.
namespace tread::shape
{
namespace
{

using scene::GrouserShape;
using scene::WheelGenerator;
using ::testing::HasSubstr;

TEST(Wheel, RejectsWhatDoesNotFit)
{
    const auto message = [](auto change)
    {
        WheelGenerator g{0.26, 0.33, 0.01, 48, 0.0125, 0.004};
        change(g);
        return test::input_error([&] { wheel_mesh(g, "shape 'w'"); });
    };
    EXPECT_THAT(message([](auto& g) { g.wall_thickness = 0.25; }), HasSubstr("shape 'w': wall_thickness = 0.25"));
    EXPECT_THAT(message([](auto& g) { g.width = 0; }), HasSubstr("width = 0"));
    EXPECT_THAT(message([](auto& g) { g.crown = 0.2; }), HasSubstr("crown = 0.2: accepted are 0 to 0.12375"));
    EXPECT_THAT(message([](auto& g) { g.grouser_width = 0.04; }), HasSubstr("grouser_width = 0.04"));
    EXPECT_THAT(message([](auto& g) { g.grouser_sweep_deg = 3; }),
                HasSubstr("grouser_sweep_deg = 3: accepted is 0 with straight grousers"));
    EXPECT_THAT(message([](auto& g) { g.grouser_shape = GrouserShape::chevron; }),
                HasSubstr("grouser_sweep_deg = 0: accepted are -60 to -0.1 and 0.1 to 60"));
    EXPECT_THAT(message([](auto& g) { g.rim_thickness = 0.01; }), HasSubstr("rim_thickness = 0.01: accepted is 0"));
    EXPECT_THAT(message([](auto& g) { g.rim_height = 0.01; }), HasSubstr("rim_thickness = 0: accepted are 0.00026"));
    EXPECT_THAT(message([](auto& g) { g.rim_height = g.rim_thickness = 0.24; }), HasSubstr("rim_height = 0.24"));
    EXPECT_THAT(message(
                    [](auto& g)
                    {
                        g.hub_radius = g.hub_width = 0.02;
                        g.web_thickness            = 0.01;
                        g.wall_thickness           = 0.227;
                        g.rim_height               = 0.01;
                    }),
                HasSubstr("hub_radius = 0.02: accepted are 0.0026 to 0.01845"));
    EXPECT_THAT(message(
                    [](auto& g)
                    {
                        g.wall_thickness = 0.235;
                        g.rim_height     = 0.2;
                    }),
                HasSubstr("rim_height = 0.2"));
    EXPECT_THAT(message([](auto& g) { g.web_thickness = 0.01; }), HasSubstr("web_thickness = 0.01: accepted is 0"));
    EXPECT_THAT(message([](auto& g) { g.hub_radius = 0.23; }), HasSubstr("hub_radius = 0.23"));
    const auto with_hub = [&](double width, double web)
    {
        return message(
            [&](auto& g)
            {
                g.hub_radius    = 0.05;
                g.hub_width     = width;
                g.web_thickness = web;
            });
    };
    EXPECT_THAT(with_hub(0.4, 0.01), HasSubstr("hub_width = 0.4: accepted are 0.00078 to 0.33"));
    EXPECT_THAT(with_hub(0.1, 0.11), HasSubstr("web_thickness = 0.11: accepted are 0.00026 to 0.09948"));
}

} // namespace
} // namespace tread::shape
