#include <gmock/gmock.h>

#include "scene_file.hpp"

// Scenes that are no file, no TOML, or empty.
namespace tread::scene::test
{
namespace
{

using ::testing::HasSubstr;

TEST(BadFile, missing)
{
    try
    {
        load_scene("/nowhere/scene.toml", {});
        FAIL() << "was accepted";
    }
    catch (const InputError& error)
    {
        EXPECT_EQ(error.code(), ExitCode::bad_input);
        EXPECT_STREQ(error.what(), "/nowhere/scene.toml: no such file");
    }
}

TEST(BadFile, directory)
{
    const Directory directory;
    EXPECT_THROW(load_scene(directory.path().string(), {}), InputError);
}

TEST(BadFile, malformed_toml_names_the_line)
{
    EXPECT_THAT(refusal("[domain]\nsize = [1, 2\ngravity = 3\n"),
                HasSubstr("bad.toml:3: malformed TOML: missing array separator `,` after a value (should be `,`)"));
    EXPECT_THAT(refusal("[domain]\nsize = [1, 1, 1]\nsize = [1, 1, 1]\n"),
                HasSubstr("bad.toml:3: malformed TOML: value (\"size\") already exists. (value defined twice)"));
}

TEST(BadFile, empty_scene_says_what_it_lacks)
{
    const auto message = refusal("");
    EXPECT_THAT(message, HasSubstr("[domain] size: missing"));
    EXPECT_THAT(message, HasSubstr("[domain] gravity: missing"));
    EXPECT_THAT(message, HasSubstr("at least one [[phase]]"));
    EXPECT_THAT(message, HasSubstr("at least one of [[terrain]], [[rocks]], [[body]]"));
}

} // namespace
} // namespace tread::scene::test
