#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "shape/generators/wheel_form.hpp"

namespace tread::shape
{
namespace
{

// Parts thinner than this fraction of the radius would come near the error of the chords.
constexpr double thinnest = 1e-3;

class WheelCheck
{
public:
    WheelCheck(const scene::WheelGenerator& wheel, const std::string& origin)
        : wheel_(wheel)
        , origin_(origin)
        , least_(thinnest * wheel.radius)
    {
    }

    void drum() const
    {
        require("radius", wheel_.radius, 1e-3, 100);
        require("width", wheel_.width, 0.05 * wheel_.radius, 20 * wheel_.radius);
        require("grousers", wheel_.grousers, 0, 1000);
        if (wheel_.grousers > 0) { require("grouser_height", wheel_.grouser_height, least_, 0.5 * wheel_.radius); }
        require("crown", wheel_.crown, 0, 0.5 * drum_radius(wheel_, 0));
        require("wall_thickness", wheel_.wall_thickness, least_, 0.95 * drum_radius(wheel_, edge()));
    }

    void grousers() const
    {
        const bool   straight = wheel_.grouser_shape == scene::GrouserShape::straight;
        const double sweep    = wheel_.grouser_sweep_deg;
        if (straight) { require("grouser_sweep_deg", sweep, 0, 0, " with straight grousers"); }
        else if (!(std::abs(sweep) >= 0.1 && std::abs(sweep) <= 60))
        {
            fail("grouser_sweep_deg", sweep, "are -60 to -0.1 and 0.1 to 60 with chevron and curved grousers");
        }
        if (wheel_.grousers == 0) { return; }
        const double pitch =
            2 * drum_radius(wheel_, edge()) * std::sin(std::numbers::pi / std::max(wheel_.grousers, 2));
        require("grouser_width", wheel_.grouser_width, least_, 0.9 * pitch);
    }

    void hub() const
    {
        if (wheel_.hub_radius == 0)
        {
            require("hub_width", wheel_.hub_width, 0, 0, " with hub_radius = 0");
            require("web_thickness", wheel_.web_thickness, 0, 0, " with hub_radius = 0");
            return;
        }
        require("hub_radius", wheel_.hub_radius, 0.01 * wheel_.radius, 0.9 * inner_radius(wheel_, edge()),
                " (or 0: an open rim)");
        require("hub_width", wheel_.hub_width, 3 * least_, wheel_.width);
        require("web_thickness", wheel_.web_thickness, least_,
                std::min(wheel_.hub_width - 2 * least_, 0.75 * wheel_.width));
    }

    void rim() const
    {
        if (wheel_.rim_height == 0)
        {
            require("rim_thickness", wheel_.rim_thickness, 0, 0, " with rim_height = 0");
            return;
        }
        require("rim_height", wheel_.rim_height, least_, 0.95 * (inner_radius(wheel_, edge()) - wheel_.hub_radius),
                " (or 0: no flanges)");
        require("rim_thickness", wheel_.rim_thickness, least_, 0.475 * (wheel_.width - wheel_.web_thickness));
    }

private:
    double edge() const { return 0.5 * wheel_.width; }

    void require(const char* key, double value, double least, double most, const char* when = "") const
    {
        if (value >= least && value <= most) { return; }
        if (least > most) { fail(key, value, "is none: the other lengths leave no room"); }
        if (least == most) { fail(key, value, fmt::format("is {:.6g}{}", least, when)); }
        fail(key, value, fmt::format("are {:.6g} to {:.6g}{}", least, most, when));
    }

    [[noreturn]] void fail(const char* key, double value, const std::string& accepted) const
    {
        throw InputError(fmt::format("{}: {} = {}: accepted {}", origin_, key, value, accepted));
    }

    const scene::WheelGenerator& wheel_;
    const std::string&           origin_;
    double                       least_; ///< m
};

} // namespace

void check_wheel(const scene::WheelGenerator& wheel, const std::string& origin)
{
    const WheelCheck check(wheel, origin);
    check.drum();
    check.grousers();
    check.hub();
    check.rim();
}

} // namespace tread::shape
