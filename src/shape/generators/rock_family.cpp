#include <fmt/format.h>

#include "base/random.hpp"
#include "shape/generators/form.hpp"
#include "shape/generators/generators.hpp"
#include "shape/template.hpp"

namespace tread::shape
{

std::vector<scene::Shape> members(const scene::Shape& shape)
{
    const auto* family = std::get_if<scene::RockGenerator>(&shape.source);
    if (family == nullptr || family->variants == 1) { return {shape}; }

    Random                    seeds(family->seed);
    std::vector<scene::Shape> rocks;
    for (int i = 0; i < family->variants; ++i)
    {
        scene::RockGenerator rock = *family;
        rock.variants             = 1;
        if (i > 0) { rock.seed = seeds.next(); }
        rocks.push_back(shape);
        rocks.back().name   = fmt::format("{}-{}", shape.name, i);
        rocks.back().source = rock;
    }
    return rocks;
}

std::vector<NamedForm> family_forms(const scene::Shape& shape)
{
    std::vector<NamedForm> forms;
    for (const scene::Shape& rock : members(shape))
    {
        const TriangleMesh mesh =
            rock_mesh(std::get<scene::RockGenerator>(rock.source), fmt::format("shape '{}'", rock.name));
        forms.push_back({rock.name, form_of(mesh)});
    }
    return forms;
}

} // namespace tread::shape
