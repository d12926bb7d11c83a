#include <cstdlib>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "scene/keys.hpp"
#include "scene/load.hpp"
#include "scene/reference.hpp"

namespace tread::scene
{
namespace
{

// ctest runs this program in tests/.
constexpr const char* page = "../docs/scene.md";

TEST(Reference, docs_scene_md_is_what_the_keys_say)
{
    const char* wanted = std::getenv("TREAD_REGENERATE_DOCS");
    if (wanted != nullptr && std::string(wanted) == "1") { std::ofstream(page) << reference_markdown(); }
    std::ostringstream text;
    text << std::ifstream(page).rdbuf();
    EXPECT_TRUE(text.str() == reference_markdown())
        << page << " is out of date; in tests/, run: TREAD_REGENERATE_DOCS=1 PATH_TO_BUILD/bin/unit_scene";
}

TEST(Reference, every_key_has_a_default_a_meaning_and_accepted_values)
{
    for_each_table(
        [](const std::string& table, const char*, auto, const auto& keys)
        {
            for (const auto& key : keys)
            {
                EXPECT_FALSE(key.text.fallback.empty()) << table << "." << key.text.name;
                EXPECT_FALSE(key.text.meaning.empty()) << table << "." << key.text.name;
                EXPECT_FALSE(key.text.accepted.empty()) << table << "." << key.text.name;
            }
        });
}

TEST(Quickstart, loads) { EXPECT_NO_THROW(load_scene("../configs/quickstart.toml", {})); }

} // namespace
} // namespace tread::scene
