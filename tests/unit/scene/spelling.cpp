#include "scene/spelling.hpp"

#include <gtest/gtest.h>

#include "scene/spellings.hpp"
#include "scene/values.hpp"

namespace tread::scene
{
namespace
{

enum class Colour
{
    red,
    green,
    blue
};

template<std::size_t n>
constexpr bool is_complete(const Spelling<Colour> (&pairs)[n])
{
    return spell_all(std::to_array(pairs));
}

static_assert(enumerators<Colour>() == 3);
static_assert(is_complete({{Colour::red, "red"}, {Colour::green, "green"}, {Colour::blue, "blue"}}));
static_assert(!is_complete({{Colour::red, "red"}, {Colour::green, "green"}}), "blue is missing");
static_assert(!is_complete({{Colour::green, "green"}, {Colour::red, "red"}, {Colour::blue, "blue"}}), "out of order");
static_assert(!is_complete({{Colour::red, "red"}, {Colour::green, "red"}, {Colour::blue, "blue"}}), "red stands twice");

TEST(Spelling, WordsAreReadAsTheirEnumerators)
{
    const Value<WallKind> wall = word<WallKind>();
    EXPECT_EQ(wall.accepted, R"("slip" | "fixed" | "frictional" | "open" | "rough")");
    EXPECT_EQ(wall.write(WallKind::rough), "\"rough\"");
    EXPECT_STREQ(word_of(MaterialModel::drucker_prager), "drucker-prager");
}

} // namespace
} // namespace tread::scene
