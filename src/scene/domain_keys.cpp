#include "scene/keys.hpp"
#include "scene/ranges.hpp"
#include "scene/spellings.hpp"

namespace tread::scene
{
namespace
{

Keys<Walls> wall_keys()
{
    const auto wall = word<WallKind>();
    return {
        optional("x", "", &Walls::x, wall, "Both walls normal to x."),
        optional("y", "", &Walls::y, wall, "Both walls normal to y."),
        optional("bottom", "", &Walls::bottom, wall, "The wall at z = 0."),
        optional("top", "", &Walls::top, wall, "The wall at z = size."),
        optional("friction", "", &Walls::friction, number(coefficient()),
                 "Coefficient of Coulomb's friction of sand with every \"frictional\" wall."),
    };
}

bool has_slope(const Domain& domain) { return domain.slope.gravity.has_value(); }

template<class M>
Key<Domain> slope_key(KeyText text, M Slope::*member, const Value<M>& value)
{
    const auto access = [member](auto& domain) -> auto& { return domain.slope.*member; };
    return make_key<Domain>(Presence::optional, std::move(text), access, value);
}

} // namespace

Keys<Domain> domain_keys()
{
    return {
        required("size", "m", &Domain::size, vector3(length()), "Edge lengths; one corner is the origin."),
        optional("gravity", "m/s2", &Domain::gravity, vector3(acceleration()), "Acceleration of gravity.",
                 "required, or `gravity_size`")
            .when("`gravity_size` left out", [](const Domain& domain) { return !has_slope(domain); }),
        slope_key({"gravity_size", "m/s2", "`gravity` gives the vector", "",
                   "Magnitude of gravity, where `slope_deg` gives its direction. The resolved scene has the vector.",
                   ""},
                  &Slope::gravity, number_or("", between(0, acceleration().high))),
        slope_key({"slope_deg", "deg", "", "",
                   "Slope of the ground, which stays level in the domain while gravity leans: positive where it rises "
                   "along `slope_direction_deg`. docs/phases.md#slopes.",
                   ""},
                  &Slope::angle_deg, number(between(-90, 90)))
            .when("`gravity_size` given", has_slope),
        slope_key({"slope_direction_deg", "deg", "", "",
                   "Direction in which the ground rises, from +x towards +y: 0 climbs along +x, 90 along +y.", ""},
                  &Slope::direction_deg, number(between(-360, 360)))
            .when("`gravity_size` given", has_slope),
        table_key<Domain>(
            Presence::optional, "walls", "[domain] walls", &Domain::walls, wall_keys(),
            "What the domain's faces do to sand: \"slip\" stops the normal velocity towards the wall, \"fixed\" all "
            "velocity, so that sand cannot come off it, \"rough\" all velocity of sand that does not come off, "
            "\"frictional\" is \"slip\" with Coulomb's friction, \"open\" lets sand leave. Rocks and bodies meet "
            "every wall that is not open; their friction with it is that of [[contact]], none with a slip one.",
            "see below"),
    };
}

} // namespace tread::scene
