#include "run/left_out.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "base/bytes_text.hpp"

namespace tread::run
{
namespace
{

/// Kind of item that a stage works on.
struct Item
{
    const char*  name;
    std::int64_t count; ///< number in the scene
};

/// Cost of one item: bytes, and nanoseconds on one core per execution, for bodies per substep (docs/performance.md,
/// "What a stage costs").
struct Price
{
    std::string name; ///< name of the stage
    Item        item;
    double      bytes;
    double      nanoseconds;
    const char* time = "step";
};

std::vector<Price> prices(const scene::Scene& scene, const world::World& world)
{
    const double real   = scene.numerics.precision == scene::Precision::single_ ? 4 : 8;
    const Item   point  = {"point", static_cast<std::int64_t>(world.sand.size())};
    const Item   body   = {"body", static_cast<std::int64_t>(world.bodies.size())};
    const Item   near   = {"point near a body", 0};
    const Item   moving = {"point and body", point.count + body.count};
    return {{solver::stage::order, point, 35, 20},
            {solver::stage::sleep, point, 133 + 51 * real, 4, "look"},
            {solver::stage::pairs, body, 700, 100},
            {solver::stage::candidates, point, 9 * real, 1},
            {solver::stage::sand_contact, near, 300, 100},
            {solver::stage::body_contact, body, 700, 1000},
            {solver::stage::integrate, body, 630, 100},
            {solver::stage::scatter, point, 20 * real, 54},
            {solver::stage::grid, point, 4 * real, 24},
            {solver::stage::gather, point, 48 + 12 * real, 143},
            {solver::stage::plasticity, point, 3 * real, 150},
            {solver::stage::damping, moving, 0, 1},
            {solver::stage::snapshots, point, 210 + 12 * real, 40, "snapshot"}};
}

} // namespace

std::string price_text(const solver::Stage& stage, const scene::Scene& scene, const world::World& world)
{
    const std::vector<Price> all = prices(scene, world);
    const auto found = std::find_if(all.begin(), all.end(), [&](const Price& one) { return one.name == stage.name; });
    if (found == all.end()) { return {}; }
    std::string text =
        fmt::format("; by model {:.0f} bytes and {:.0f} ns a {}", found->bytes, found->nanoseconds, found->item.name);
    if (found->item.count == 0) { return text; }
    const auto count = static_cast<double>(found->item.count);
    return text + fmt::format(": {}, {:.3g} ms a {}", bytes_text(static_cast<std::int64_t>(count * found->bytes)),
                              1e-6 * count * found->nanoseconds, found->time);
}

} // namespace tread::run
