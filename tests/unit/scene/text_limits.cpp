#include <gmock/gmock.h>

#include "scene/text.hpp"
#include "scene/text_limits.hpp"
#include "scene_file.hpp"

namespace tread::scene::test
{
namespace
{

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string repeated(const std::string& part, std::size_t times)
{
    std::string text;
    text.reserve(part.size() * times);
    for (std::size_t i = 0; i < times; ++i) { text += part; }
    return text;
}

TEST(TextLimits, arrays_in_each_other)
{
    EXPECT_FALSE(excess_of("a = " + repeated("[", most_depth) + repeated("]", most_depth)));
    const auto message = refusal(good_scene + "a = " + repeated("[", 10'000) + repeated("]", 10'000) + "\n");
    EXPECT_THAT(message, HasSubstr("bad.toml:58: values nested 33 deep or more; accepted: at most 32 deep"));
}

TEST(TextLimits, tables_in_each_other)
{
    std::string text;
    for (int level = 0; level < 20'000; ++level) { text += level % 100 == 99 ? "{a\n= " : "{a = "; }
    EXPECT_THAT(refusal("# tables\nx = " + text), HasSubstr("bad.toml:2: values nested 33 deep or more"));
}

TEST(TextLimits, brackets_of_strings_and_comments_do_not_count)
{
    const std::string many = repeated("[{", 100), dots = repeated("a.", 100);
    EXPECT_FALSE(excess_of("a = \"\\\"" + many + dots + "\" # " + many + dots + "\nb = '" + many + "'\n"));
    EXPECT_FALSE(
        excess_of("a = \"\"\"" + many + "\n\\\"\"\"" + many + "\"\"\"\nb = '''" + many + "\n''" + many + "'''\n"));
    EXPECT_TRUE(excess_of("a = \"\"\"x\"\"\"\nb = " + many));
    EXPECT_TRUE(excess_of("a = 'x\\'\nb = " + many));
    EXPECT_TRUE(excess_of("a = [\"\"\"x\"\"\"\"\", " + many));
    EXPECT_TRUE(excess_of("a = \"no end\nb = " + many));
}

TEST(TextLimits, segments_of_a_key)
{
    EXPECT_FALSE(excess_of(repeated("a.", most_segments - 1) + "a = 1\n"));
    EXPECT_FALSE(excess_of("a = [" + repeated("1.5, ", 1000) + "]\n"));
    const auto message = refusal("title = \"x\"\n" + repeated("a.", 10'000) + "a = 1\n");
    EXPECT_THAT(message, HasSubstr("bad.toml:2: a key of 33 segments or more; accepted: at most 32 segments"));
    EXPECT_THAT(refusal("[" + repeated("\"a\".", 100) + "a]\n"), HasSubstr("bad.toml:1: a key of 33 segments"));
}

TEST(TextLimits, only_utf_8)
{
    EXPECT_FALSE(excess_of("title = 'f\u00fcr \u7802, \U0001f6de' # \ue000 \U0010ffff\n"));
    for (const std::string wrong : {"\xfd", "\x80", "\xc0\x80", "\xe0\x9f\xbf", "\xed\xa0\x80", "\xf0\x8f\xbf\xbf",
                                    "\xf4\x90\x80\x80", "\xe2\x82", "\xf0\x9f\x9b"})
    {
        EXPECT_TRUE(excess_of("title = '" + wrong + "'\n")) << wrong;
        EXPECT_TRUE(excess_of("title = '" + wrong)) << wrong;
    }
    EXPECT_THAT(refusal("# one\ntitle = '\xfdR'\n"),
                HasSubstr("bad.toml:2: the byte 0xfd, which is not UTF-8; accepted: a text in UTF-8"));
}

TEST(TextLimits, a_long_line)
{
    EXPECT_FALSE(excess_of(std::string(most_line, ' ') + "\n"));
    EXPECT_THAT(refusal("\n\na = { b = 1, " + repeated("c", 40'000) + " = [1,2\n"),
                HasSubstr("bad.toml:3: a line of 40020 bytes; accepted: at most 32768 bytes a line"));
}

TEST(TextLimits, a_missing_brace_on_a_line_within_the_limit)
{
    const auto message = refusal("\na = [ " + repeated("{b = 1}, ", 3000) + "{b = 1 ]\n");
    EXPECT_THAT(message, HasSubstr("bad.toml:2: malformed TOML: missing table separator `,`"));
    EXPECT_LT(message.size(), 1000u);
}

TEST(TextLimits, a_large_file)
{
    const auto message = refusal(good_scene + repeated("# filling\n", most_bytes / 10));
    EXPECT_THAT(message, HasSubstr("bad.toml: a file of "));
    EXPECT_THAT(message, HasSubstr("accepted: at most 1048576 bytes"));
}

TEST(TextLimits, overrides)
{
    EXPECT_THAT(refusal(good_scene, {"title=" + repeated("x", 40'000)}),
                AllOf(StartsWith("--set title=xxx"), HasSubstr("a line of 40006 bytes"),
                      HasSubstr("accepted: at most 32768 bytes a line")));
    EXPECT_THAT(refusal(good_scene, {"title=" + repeated("[", 20'000)}), HasSubstr("values nested 33 deep"));
    EXPECT_THAT(refusal(good_scene, {repeated("a.", 15'000) + "a=1"}), HasSubstr("a key of 33 segments"));
    EXPECT_EQ(refusal(good_scene, {"title=" + repeated("x", 30'000)}), "");
}

TEST(TextLimits, lines_of_values_are_right_whatever_ends_and_begins_them)
{
    EXPECT_THAT(refusal("\xef\xbb\xbf" + replaced(good_scene, "young = 1e6", "young = -1e6")),
                HasSubstr("bad.toml:11: "));
    EXPECT_THAT(refusal(replaced(good_scene, "[0, 0, -9.81]", "[0,\n0,\n\"x\"]")),
                HasSubstr("bad.toml:4: [domain] gravity"));
}

TEST(TextLimits, many_errors_are_counted)
{
    std::string text = good_scene;
    for (int key = 0; key < 300; ++key) { text += "wrong_" + std::to_string(key) + " = 1\n"; }
    const auto message = refusal(text);
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 100);
    EXPECT_THAT(message, HasSubstr("\nand 200 errors more"));
}

TEST(TextLimits, too_many_tables)
{
    EXPECT_THAT(refusal(good_scene + repeated("[[body]]\n", 1001)),
                HasSubstr("body: 1002 tables; accepted: at most 1000 tables [[body]]"));
}

TEST(Shown, cuts_at_letters_and_hides_control_characters)
{
    EXPECT_EQ(shown("wheel"), "wheel");
    EXPECT_EQ(shown("a\x1b[2Jb\n"), "a?[2Jb?");
    EXPECT_EQ(shown(repeated("\xc3\xa4", 10), 5), "\xc3\xa4\xc3\xa4...");
}

} // namespace
} // namespace tread::scene::test
