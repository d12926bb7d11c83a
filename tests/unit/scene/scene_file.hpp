#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <unistd.h>

#include "base/errors.hpp"
#include "scene/load.hpp"

namespace tread::scene::test
{

/// A directory that exists as long as the test.
class Directory
{
public:
    Directory()
        : path_(std::filesystem::temp_directory_path() / ("tread_scene_" + std::to_string(::getpid())))
    {
        std::filesystem::create_directories(path_);
    }
    ~Directory() { std::filesystem::remove_all(path_); }
    Directory(const Directory&)            = delete;
    Directory& operator=(const Directory&) = delete;

    std::string write(const std::string& name, const std::string& text) const
    {
        std::ofstream(path_ / name) << text;
        return (path_ / name).string();
    }

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

/// A scene with one of each table; tests count lines in its text.
inline const std::string good_scene = R"(title = "good"
[domain]
size = [1, 1.0, 1]
gravity = [0, 0, -9.81]
[grid]
spacing = 0.05
[[material]]
name = "sand"
model = "mohr-coulomb"
density = 1600
young = 1e6
poisson = 0.3
friction_angle_deg = 30
dilation_angle_deg = 5
[[material]]
name = "rock"
model = "elastic"
density = 2700.0
young = 1e7
poisson = 0.2
[[material]]
name = "steel"
model = "rigid"
young = 7e10
family = "wheel"
[[contact]]
between = ["wheel", "sand"]
friction = 0.4
[[shape]]
name = "clast"
generate = { kind = "rock", seed = 3 }
[[terrain]]
material = "sand"
region = { box = [[0, 0, 0], [1, 1, 0.2]] }
points_per_cell = 8
[[rocks]]
shape = "clast"
material = "rock"
count = 5
diameter = 0.05
region = { box = [[0, 0, 0.1], [1, 1, 0.2]] }
placement = "replace"
[[body]]
name = "wheel"
shape = "perseverance"
material = "steel"
mass = 10
position = [0.5, 0.5, 0.6]
[[phase]]
name = "settle"
hold = ["wheel"]
until = "equilibrium"
max_duration = 1
[[phase]]
name = "drive"
duration = 2
drive = { body = "wheel", angular_velocity = 0.7, slip = 0.3 }
)";

/// `text` with the first `from` replaced by `to`; throws if there is none, so that every case tests what it should.
inline std::string replaced(std::string text, const std::string& from, const std::string& to)
{
    const auto place = text.find(from);
    if (place == std::string::npos) { throw std::logic_error("not in the scene: " + from); }
    return text.replace(place, from.size(), to);
}

/// Error message for a scene; empty if it is accepted.
inline std::string refusal(const std::string& text, const std::vector<std::string>& overrides = {})
{
    const Directory directory;
    try
    {
        load_scene(directory.write("bad.toml", text), overrides);
    }
    catch (const InputError& error)
    {
        return error.what();
    }
    return {};
}

} // namespace tread::scene::test
