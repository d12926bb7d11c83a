#include "scene/formula.hpp"
#include "scene/keys.hpp"
#include "scene/ranges.hpp"

namespace tread::scene
{
namespace
{

Keys<Sphere> sphere_region_keys()
{
    return {
        required("centre", "m", &Sphere::centre, vector3(coordinate()), "Of the sphere."),
        required("radius", "m", &Sphere::radius, number(length()), "Of the sphere."),
    };
}

Keys<Region> region_keys()
{
    return {
        optional("box", "m", &Region::box, box_given(), "Lower and upper corner; or `sphere`.", "the domain"),
        table_key<Region>(Presence::optional, "sphere", "[[terrain]] region sphere", &Region::sphere,
                          sphere_region_keys(), "A ball instead of a box.", "or `box`"),
        optional("except", "m", &Region::except, boxes(), "Cut out of the box or sphere."),
    };
}

bool ends_with(const std::string& text, const std::string& end)
{
    return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

Keys<RasterFile> raster_keys()
{
    const auto is_picture = [](const RasterFile& raster) { return ends_with(raster.path, ".pgm"); };
    const auto is_numbers = [](const RasterFile& raster) { return ends_with(raster.path, ".csv"); };
    return {
        required("file", "", &RasterFile::path, text(),
                 "Grey values (PGM, P2 or P5, 8 or 16 bits) or rows of numbers (CSV) on a rectangular lattice, the "
                 "first row at high y; bilinear between them. Ends in .pgm or .csv; a relative path starts at the "
                 "scene file."),
        required("low", "m", &RasterFile::low, number(coordinate()), "Height of black.")
            .when("file = \"*.pgm\"", is_picture),
        required("high", "m", &RasterFile::high, number(coordinate()), "Height of white.")
            .when("file = \"*.pgm\"", is_picture),
        optional("unit", "", &RasterFile::unit, length_unit(), "Of the heights.").when("file = \"*.csv\"", is_numbers),
        optional("extent", "m", &RasterFile::extent, extent_given(), "Where the outermost samples stand.",
                 "the domain's plan"),
    };
}

void read_height(const Node& node, const std::string& table, const std::string& key, std::optional<Height>& height,
                 Problems& problems)
{
    if (const auto* formula = std::get_if<std::string>(&node.value))
    {
        const auto problem = formula_problem(*formula);
        if (!problem.empty()) { problems.push_back({node.where, table, key, problem, formula_language}); }
        height = Formula{*formula};
        return;
    }
    if (!std::holds_alternative<NodeTable>(node.value))
    {
        problems.push_back({node.where, table, key, "wrong type: " + kind_of(node),
                            std::string(formula_language) + ", or table with file"});
        return;
    }
    RasterFile raster;
    read_table(node, table + "." + key, raster_keys(), raster, problems);
    height = raster;
}

std::string write_height(const std::optional<Height>& height)
{
    if (!height) { return {}; }
    if (const auto* formula = std::get_if<Formula>(&*height)) { return write_string(formula->text); }
    return write_inline(raster_keys(), std::get<RasterFile>(*height));
}

template<class T>
Key<T> height_key(const std::string& name, std::optional<Height> T::*member, const std::string& fallback,
                  const std::string& meaning, const std::vector<TableText>& inner)
{
    KeyText text{name,     "m",
                 fallback, std::string("string: ") + formula_language + "; or table, see [[terrain]] height",
                 meaning,  ""};
    auto    read = [=](const Node& node, const std::string& table, T& object, Problems& problems)
    { read_height(node, table, name, object.*member, problems); };
    auto write = [=](const T& object) { return write_height(object.*member); };
    return {text, Presence::optional, [](const T&) { return true; }, read, write, inner};
}

template<class T>
Key<T> region_key(const std::string& meaning, const std::vector<TableText>& inner)
{
    auto key  = table_key<T>(Presence::optional, "region", "[[terrain]] region", &T::region, region_keys(), meaning,
                            "the domain");
    key.inner = inner;
    return key;
}

std::vector<TableText> describe_region()
{
    return {describe("[[terrain]] region", "", region_keys()),
            describe("[[terrain]] region sphere", "", sphere_region_keys())};
}

std::vector<TableText> describe_height() { return {describe("[[terrain]] height", "", raster_keys())}; }

Keys<UniformDiameters> uniform_keys()
{
    return {
        required("low", "m", &UniformDiameters::low, number(length()), "Smallest."),
        required("high", "m", &UniformDiameters::high, number(length()), "Largest."),
    };
}

Keys<LogNormalDiameters> log_normal_keys()
{
    return {
        required("median", "m", &LogNormalDiameters::median, number(length()), "Of the distribution untruncated."),
        required("deviation", "", &LogNormalDiameters::deviation, number(between(1e-6, 100)),
                 "Standard deviation of the natural logarithm of the diameter."),
        required("low", "m", &LogNormalDiameters::low, number(length()), "Smallest: the distribution is cut there."),
        required("high", "m", &LogNormalDiameters::high, number(length()), "Largest: the distribution is cut there."),
    };
}

Keys<PowerLawDiameters> power_law_keys()
{
    return {
        required("exponent", "", &PowerLawDiameters::exponent, number(between(-20, 20)),
                 "Rocks per unit of diameter are as diameter^-exponent."),
        required("low", "m", &PowerLawDiameters::low, number(length()), "Smallest."),
        required("high", "m", &PowerLawDiameters::high, number(length()), "Largest."),
    };
}

/// Calls visit(word, keys) for each distribution.
template<class Visit>
void for_each_distribution(Visit&& visit)
{
    visit("uniform", uniform_keys());
    visit("log-normal", log_normal_keys());
    visit("power-law", power_law_keys());
}

std::vector<std::string> distributions()
{
    std::vector<std::string> words;
    for_each_distribution([&](const std::string& word, const auto&) { words.push_back(word); });
    return words;
}

void read_distribution(const Node& node, const std::string& label, Diameter& diameter, Problems& problems)
{
    const auto  words  = distributions();
    const Node* given  = find(node, "distribution");
    std::size_t chosen = words.size();
    try
    {
        if (given == nullptr) { throw BadValue{"missing"}; }
        chosen = read_word(*given, words);
    }
    catch (const BadValue& bad)
    {
        problems.push_back(
            {given != nullptr ? given->where : node.where, label, "distribution", bad.what, list_words(words)});
        return;
    }
    Node parameters = node;
    std::get<NodeTable>(parameters.value).erase("distribution");
    for_each_distribution(
        [&](const std::string& word, const auto& keys)
        {
            if (word != words[chosen]) { return; }
            auto distribution = made_by(keys);
            read_table(parameters, label, keys, distribution, problems);
            diameter = distribution;
        });
}

std::string write_diameter(const Rocks& rocks)
{
    if (const auto* one = std::get_if<double>(&rocks.diameter)) { return number(length()).write(*one); }
    std::string text;
    for_each_distribution(
        [&](const std::string& word, const auto& keys)
        {
            const auto* distribution = std::get_if<decltype(made_by(keys))>(&rocks.diameter);
            if (distribution == nullptr) { return; }
            text = "{ distribution = " + write_string(word) + ", " + write_keys(keys, *distribution, ", ") + " }";
        });
    return text;
}

} // namespace

Key<Terrain> terrain_region_key()
{
    return region_key<Terrain>("Where the points are; inside the domain.", describe_region());
}

Key<Rocks> rocks_region_key() { return region_key<Rocks>("The rocks lie in it whole; inside the domain.", {}); }

Key<Terrain> terrain_height_key()
{
    return height_key("height", &Terrain::height, "the region's top", "Points lie below this surface.",
                      describe_height());
}

Key<Terrain> terrain_floor_key()
{
    return height_key("floor", &Terrain::floor, "the region's bottom", "Points lie on or above this surface.", {});
}

Key<Rocks> rocks_height_key()
{
    return height_key("height", &Rocks::height, "the region's top", "The rocks lie whole below this surface.", {});
}

Key<Rocks> rocks_floor_key()
{
    return height_key("floor", &Rocks::floor, "the region's bottom", "The rocks lie whole above this surface.", {});
}

Key<Rocks> rocks_diameter_key()
{
    const std::string      label = "[[rocks]] diameter, distribution = ";
    std::vector<TableText> inner;
    for_each_distribution([&](const std::string& word, const auto& keys)
                          { inner.push_back(describe(label + write_string(word), "", keys)); });
    const std::string accepted = length().text() + " (m), or table with distribution = " + list_words(distributions());
    KeyText           text{"diameter",
                 "",
                 "required",
                 accepted,
                 "Of the spheres of equal volume: one for all rocks, or a distribution by number.",
                 ""};
    auto              read = [=](const Node& node, const std::string& table, Rocks& rocks, Problems& problems)
    {
        if (std::holds_alternative<NodeTable>(node.value))
        {
            read_distribution(node, table + ".diameter", rocks.diameter, problems);
            return;
        }
        try
        {
            rocks.diameter = read_number(node, length());
        }
        catch (const BadValue& bad)
        {
            problems.push_back({node.where, table, "diameter", bad.what, accepted_with_unit(text)});
        }
    };
    return {text, Presence::required, [](const Rocks&) { return true; }, read, write_diameter, inner};
}

} // namespace tread::scene
