#include <cmath>

#include <gmock/gmock.h>

#include "scene/resolved.hpp"
#include "scene_file.hpp"

namespace tread::scene::test
{
namespace resolved_test
{

using ::testing::HasSubstr;

/// A scene in which every key that can differ from its default does.
const std::string full_scene = R"(title = "quotes \" and \\ and \t tab"
[domain]
size = [2, 3, 4]
gravity = [0.1, 0.2, -0.30000000000000004]
walls = { x = "fixed", y = "open", bottom = "slip", top = "frictional", friction = 0.7 }
[grid]
spacing = 0.1
[time]
dt = 1e-5
substeps = 7
contact_share = 0.3
[numerics]
precision = "double"
transfer = "apic"
shape_functions = "linear"
narrow_phase = "rays"
point_motion = "frozen"
hertz = "paper-eq7"
point_radius = "semi-domain"
refine_below = 1.5
volume_strain = "cell-average"
linear_overlap = 1e-7
[[material]]
name = "sand"
model = "drucker-prager"
density = 1600
young = 1e15
poisson = 0.1
friction_angle_deg = 30
dilation_angle_deg = 5
cohesion = 100
family = "ripple"
drucker_prager_fit = "plane-strain"
[[material]]
name = "steel"
model = "rigid"
young = 2e11
density = 7800
[[contact]]
between = ["ripple", "steel"]
friction = 0.7
restitution = 0.1
[[contact]]
between = ["wall", "steel"]
[[shape]]
name = "a"
generate = { kind = "rock", seed = 3, aspect = 0.5, sphericity = 0.8, nodes = 642 }
sdf_cells = 33
node_spacing = 0.25
[[shape]]
name = "b"
generate = { kind = "sphere", nodes = 42 }
[[shape]]
name = "c"
generate = { kind = "wheel", radius = 1, width = 2, wall_thickness = 0.1, grousers = 3, grouser_height = 0.2, grouser_width = 0.3, grouser_shape = "chevron", grouser_sweep_deg = -5, crown = 0.05, rim_height = 0.06, rim_thickness = 0.07, hub_radius = 0.3, hub_width = 0.4, web_thickness = 0.08 }
[[shape]]
name = "d"
file = "mesh.stl"
unit = "mm"
repair = true
[[shape]]
name = "e"
file = "mesh.stl"
unit = 0.3048
[[shape]]
name = "box"
generate = { kind = "box", size = [0.1, 0.2, 0.3] }
[[shape]]
name = "square"
generate = { kind = "plate", size = [0.1, 0.2], thickness = 0.01 }
[[shape]]
name = "disc"
generate = { kind = "plate", radius = 0.1, thickness = 0.01 }
[[shape]]
name = "bar"
generate = { kind = "cylinder", radius = 0.1, length = 0.5 }
[[shape]]
name = "cone"
generate = { kind = "cone", apex_angle_deg = 60, base_radius = 0.02, shaft_radius = 0.01, shaft_length = 0.3 }
[[shape]]
name = "ring"
generate = { kind = "ring", inner_radius = 0.05, outer_radius = 0.1, height = 0.01, vanes = 8, vane_height = 0.02, vane_thickness = 0.003 }
[[shape]]
name = "tube"
generate = { kind = "tube", radius = 0.1, wall_thickness = 0.01, length = 0.5 }
[[shape]]
name = "tray"
generate = { kind = "frame", inner_size = [0.1, 0.2], height = 0.05, wall_thickness = 0.01, floor_thickness = 0.02 }
[[shape]]
name = "rig"
assemble = [ { shape = "viper" }, { shape = "bar", at = [0, 0.1, -0.2], axis = [1, 0, 0], angle_deg = 90, scale = 0.5 } ]
[[terrain]]
material = "sand"
region = { box = [[0, 0.5, 0], [1, 1, 0.3333333333333333]] }
points_per_cell = 27
[[rocks]]
shape = "a"
material = "steel"
count = 12
diameter = 0.1
region = { box = [[0, 0, 0], [1, 1, 1]] }
placement = "rain"
seed = 9007199254740993
[[body]]
name = "one"
shape = "c"
material = "steel"
density = 5
position = [1, 1, 1]
velocity = [1, 2, 3]
rolling_radius = 0.9
lock = ["x", "yaw"]
yaw_deg = 12.5
camber_deg = -3
[[body]]
name = "two"
shape = "perseverance"
material = "steel"
mass = 5
position = [1, 1, 1]
axis = [0, 3, 0.1]
angle_deg = -20.25
[[body]]
name = "three"
shape = "spirit"
material = "steel"
load = 5
position = [1, 1, 1]
rows = [[0.6, -0.8, 0], [0.8, 0.6, 0], [0, 0, 1]]
[[phase]]
name = "settle"
hold = ["one", "two"]
damping = 0.5
until = "equilibrium"
max_duration = 3
[[phase]]
name = "drive"
duration = 2
drive = { body = "one", angular_velocity = -0.7, ramp = 0.5, slip = -0.3 }
[[phase]]
name = "free"
duration = 2
drive = { body = "two", angular_velocity = 1 }
[output]
every = 0.5
snapshots_every = 1.5
)";

Scene load_text(const Directory& directory, const std::string& text)
{
    return load_scene(directory.write("scene.toml", text), {});
}

Scene load_full(const Directory& directory)
{
    directory.write("mesh.stl", "");
    return load_text(directory, full_scene);
}

TEST(Resolved, round_trips_every_key_from_another_directory)
{
    const Directory directory;
    const auto      scene = load_full(directory);
    std::filesystem::create_directories(directory.path() / "run");
    auto again = load_scene(directory.write("run/scene.toml", resolved_toml(scene)), {});
    EXPECT_NE(again.directory, scene.directory);
    again.directory = scene.directory;
    EXPECT_TRUE(again == scene) << resolved_toml(scene) << "\nread back as\n" << resolved_toml(again);
    EXPECT_EQ(resolved_toml(again), resolved_toml(scene));
}

TEST(Resolved, what_was_read_is_what_was_written)
{
    const Directory directory;
    const auto      scene = load_full(directory);
    EXPECT_EQ(scene.title, "quotes \" and \\ and \t tab");
    EXPECT_EQ(scene.domain.gravity[2], -0.30000000000000004);
    EXPECT_EQ(scene.domain.walls, (Walls{WallKind::fixed, WallKind::open, WallKind::slip, WallKind::frictional, 0.7}));
    EXPECT_EQ(scene.time, (TimeOptions{1e-5, 7, 0.3}));
    EXPECT_EQ(scene.numerics, (Numerics{Precision::double_, Transfer::apic, std::nullopt, ShapeFunctions::linear,
                                        NarrowPhase::rays, PointMotion::frozen, HertzFactor::paper_eq7,
                                        PointRadius::semi_domain, 1.5, 1e-7, VolumeStrain::cell_average}));
    EXPECT_EQ(scene.materials[0], (Material{"sand", MaterialModel::drucker_prager, 1600, 1e15, 0.1, 30, 5, 100,
                                            "ripple", ConeFit::plane_strain}));
    EXPECT_EQ(scene.materials[1].family, "steel");
    EXPECT_EQ(std::get<WheelGenerator>(scene.shapes[2].source),
              (WheelGenerator{1, 2, 0.1, 3, 0.2, 0.3, GrouserShape::chevron, -5, 0.05, 0.06, 0.07, 0.3, 0.4, 0.08}));
    EXPECT_EQ(std::get<MeshFile>(scene.shapes[3].source),
              (MeshFile{(directory.path() / "mesh.stl").string(), 0.001, true}));
    EXPECT_EQ(std::get<MeshFile>(scene.shapes[4].source).unit, 0.3048);
    EXPECT_EQ(std::get<BoxGenerator>(scene.shapes[5].source), (BoxGenerator{{0.1, 0.2, 0.3}}));
    EXPECT_EQ(std::get<PlateGenerator>(scene.shapes[6].source),
              (PlateGenerator{std::nullopt, Vector2{0.1, 0.2}, 0.01}));
    EXPECT_EQ(std::get<PlateGenerator>(scene.shapes[7].source), (PlateGenerator{0.1, std::nullopt, 0.01}));
    EXPECT_EQ(std::get<CylinderGenerator>(scene.shapes[8].source), (CylinderGenerator{0.1, 0.5}));
    EXPECT_EQ(std::get<ConeGenerator>(scene.shapes[9].source), (ConeGenerator{60, 0.02, 0.01, 0.3}));
    EXPECT_EQ(std::get<RingGenerator>(scene.shapes[10].source), (RingGenerator{0.05, 0.1, 0.01, 8, 0.02, 0.003}));
    EXPECT_EQ(std::get<TubeGenerator>(scene.shapes[11].source), (TubeGenerator{0.1, 0.01, 0.5}));
    EXPECT_EQ(std::get<FrameGenerator>(scene.shapes[12].source), (FrameGenerator{{0.1, 0.2}, 0.05, 0.01, 0.02}));
    EXPECT_EQ(std::get<Assembly>(scene.shapes[13].source),
              (Assembly{{{"viper"}, {"bar", {0, 0.1, -0.2}, {1, 0, 0}, 90, 0.5}}}));
    EXPECT_EQ(scene.bodies[0].orientation, (Orientation{{}, {}, {}, 12.5, -3}));
    EXPECT_EQ(scene.bodies[1].orientation, (Orientation{Vector3{0, 3, 0.1}, -20.25, {}, {}, {}}));
    EXPECT_EQ(scene.bodies[2].orientation,
              (Orientation{{}, {}, Matrix3{{{0.6, -0.8, 0}, {0.8, 0.6, 0}, {0, 0, 1}}}, {}, {}}));
    EXPECT_EQ(scene.rocks[0].seed, 9007199254740993u);
    EXPECT_EQ(scene.bodies[0].lock, (std::vector<std::string>{"x", "yaw"}));
    EXPECT_EQ(scene.phases[1].drive, (Drive{"one", -0.7, 0.5, -0.3}));
    EXPECT_FALSE(scene.phases[2].drive->slip.has_value());
}

TEST(Resolved, keeps_a_pic_rate)
{
    const Directory directory;
    const auto      scene = load_scene(directory.write("scene.toml", good_scene), {"numerics.pic_rate=0.125"});
    EXPECT_EQ(scene.numerics.pic_rate, 0.125);
    EXPECT_EQ(load_text(directory, resolved_toml(scene)), scene);
}

TEST(Resolved, keeps_a_body_perfectly_stiff)
{
    const Directory directory;
    auto            text = replaced(good_scene, "young = 7e10\n", "");
    text                 = replaced(text, "size = [1, 1.0, 1]",
                                    "size = [1, 1.0, 1]\nwalls = { x = \"open\", y = \"open\", bottom = \"open\" }");
    const auto scene     = load_text(directory, text);
    EXPECT_TRUE(std::isinf(scene.materials[2].young));
    EXPECT_EQ(load_text(directory, resolved_toml(scene)), scene);
}

TEST(Resolved, shows_every_key_that_was_left_to_its_default)
{
    const Directory directory;
    const auto      text = resolved_toml(load_text(directory, good_scene));
    for (const auto* line :
         {"dt = \"auto\"", "substeps = \"auto\"", "precision = \"single\"", "pic_rate = \"auto\"",
          "linear_overlap = 0.001", "contact_share = 0.2", "cohesion = 0.0", "family = \"sand\"",
          "sdf_cells = \"auto\"", "rolling_radius = \"auto\"", "lock = []", "damping = 0.0", "every = 0.02",
          "walls = { x = \"slip\", y = \"slip\", bottom = \"fixed\", top = \"open\", friction = 0.5 }"})
    {
        EXPECT_THAT(text, HasSubstr(std::string(line) + "\n"));
    }
    EXPECT_THAT(text, HasSubstr("between = [\"rock\", \"wall\"]\nfriction = 0.5\nrestitution = 0.5\n"));
    EXPECT_THAT(text, HasSubstr("between = [\"rock\", \"wheel\"]\nfriction = 0.3\n"));
}

TEST(SceneHash, is_that_of_the_run_and_not_of_its_spelling)
{
    const Directory directory;
    const auto      hash     = scene_hash(load_text(directory, good_scene));
    const auto      spelling = replaced(good_scene, "size = [1, 1.0, 1]", "size = [1.0, 1, 1e0] # the same");
    const auto      title    = replaced(good_scene, "title = \"good\"", "title = \"another\"");
    const auto      slip     = replaced(good_scene, "slip = 0.3", "slip = 0.30000000000000004");
    EXPECT_THAT(hash, ::testing::MatchesRegex("[0-9a-f]{16}"));
    EXPECT_EQ(scene_hash(load_text(directory, spelling)), hash);
    EXPECT_EQ(scene_hash(load_text(directory, title)), hash);
    EXPECT_NE(scene_hash(load_text(directory, slip)), hash);
}

TEST(SceneHash, knows_nothing_of_the_right_answer)
{
    const Directory directory;
    const auto      measured = directory.write("measured.csv", "time,torque\n0,0\n");
    const auto      scene    = load_text(directory, good_scene);
    const auto      form     = load_text(directory, good_scene + "[reference]\nform = \"weight\"\n");
    const auto      file     = load_text(directory, good_scene + "[reference]\nfile = \"measured.csv\"\n");
    EXPECT_EQ(form.reference.form, ReferenceForm::weight);
    EXPECT_EQ(file.reference.file, measured);
    for (const Scene& known : {form, file})
    {
        EXPECT_EQ(load_text(directory, resolved_toml(known)), known);
        EXPECT_EQ(scene_hash(known), scene_hash(scene));
    }
}

TEST(SceneHash, of_an_empty_scene_is_fnv1a_of_its_text)
{
    std::uint64_t hash = 14695981039346656037u;
    for (const char letter : resolved_toml(Scene{}))
    {
        hash = (hash ^ static_cast<unsigned char>(letter)) * 1099511628211u;
    }
    EXPECT_EQ(std::stoull(scene_hash(Scene{}), nullptr, 16), hash);
}

} // namespace resolved_test
} // namespace tread::scene::test
