#include <algorithm>
#include <ostream>

#include <gmock/gmock.h>

#include "scene_file.hpp"

namespace tread::scene::test
{
namespace
{

using ::testing::HasSubstr;

/// Replaces `from` in the good scene by `to`; the only message must start at `line` and contain `said`.
struct BadCase
{
    const char* name;
    std::string from;
    std::string to;
    int         line;
    std::string said;
};

std::ostream& operator<<(std::ostream& stream, const BadCase& bad) { return stream << bad.name; }

class BadInput : public ::testing::TestWithParam<BadCase>
{
};

TEST_P(BadInput, is_refused_with_file_line_and_key)
{
    const auto& bad     = GetParam();
    const auto  message = refusal(replaced(good_scene, bad.from, bad.to));
    EXPECT_THAT(message, HasSubstr("bad.toml:" + std::to_string(bad.line) + ": "));
    EXPECT_THAT(message, HasSubstr(bad.said));
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 0) << message;
}

const std::vector<BadCase> key_cases{
    {"unknown_key", "spacing = 0.05", "spacing = 0.05\nspacin = 1", 7,
     "[grid] spacin: unknown key; did you mean \"spacing\"?; accepted: spacing"},
    {"misspelt_key_on_which_others_hang", "until = \"equi", "untill = \"equi", 52,
     "[phase.settle] untill: unknown key"},
    {"unknown_table", "[grid]", "[restart]\nkeep = 2\n[grid]", 5, " restart: unknown key"},
    {"misspelt_table", "[grid]", "[numeric]\nhertz = \"standard\"\n[grid]", 5, "did you mean \"numerics\"?"},
    {"unknown_narrow_phase", "[grid]", "[numerics]\nnarrow_phase = \"triangles\"\n[grid]", 6,
     "[numerics] narrow_phase: unknown word \"triangles\"; accepted: \"sdf\" | \"rays\""},
    {"unknown_reference", "[grid]", "[reference]\nform = \"bagnold\"\n[grid]", 6,
     "[reference] form: unknown word \"bagnold\"; accepted: \"none\" | \"hertz-impact\""},
    {"reference_without_its_file", "[grid]", "[reference]\nfile = \"nowhere.csv\"\n[grid]", 6,
     "nowhere.csv; accepted: CSV"},
    {"wrong_type", "young = 1e6", "young = \"stiff\"", 11,
     "[material.sand] young: wrong type: the string \"stiff\"; accepted: number >= 1 and <= 1e+18 (Pa)"},
    {"boolean", "young = 1e6", "young = true", 11, "wrong type: a boolean"},
    {"date", "young = 1e6", "young = 2024-01-01", 11, "wrong type: a date or time"},
    {"float_for_integer", "count = 5", "count = 5.5", 39, "[rocks[0]] count: wrong type: a floating-point number"},
    {"integer_beyond_64_bits", "seed = 3", "seed = 99999999999999999999", 31,
     "seed: wrong type: a number too large to hold"},
    {"number_beyond_doubles", "young = 1e6", "young = 1e999", 11, "young: wrong type: a number too large to hold"},
    {"not_a_number", "young = 1e6", "young = nan", 11,
     "nan is not a finite number; accepted: number >= 1 and <= 1e+18 (Pa)"},
    {"infinity", "young = 1e6", "young = inf", 11, "inf is not a finite number"},
    {"nan_in_vector", "-9.81]", "nan]", 4, "[domain] gravity: element 2: nan is not a finite number"},
    {"negative_density", "density = 1600", "density = -1600", 10,
     "[material.sand] density: -1600 is out of range; accepted: number >= 0.001 and <= 1e+06 (kg/m3)"},
    {"zero_young", "young = 1e6", "young = 0", 11, "0 is out of range; accepted: number >= 1 and <= 1e+18 (Pa)"},
    {"incompressible", "poisson = 0.3", "poisson = 0.5", 12,
     "poisson: 0.5 is out of range; accepted: number >= 0 and <= 0.499"},
    {"negative_poisson", "poisson = 0.3", "poisson = -0.1", 12, "poisson: -0.1 is out of range"},
    {"flat_domain", "size = [1, 1.0, 1]", "size = [1, 1.0, 0]", 3, "[domain] size: element 2: 0 is out of range"},
    {"two_components", "size = [1, 1.0, 1]", "size = [1, 1.0]", 3, "2 elements instead of 3"},
    {"bad_name", "name = \"clast\"", "name = \"my clast\"", 30, "name: \"my clast\" is not a name"},
    {"unknown_word", "model = \"elastic\"", "model = \"elastik\"", 17,
     "[material.rock] model: unknown word \"elastik\"; did you mean \"elastic\"?; accepted: \"elastic\" | "
     "\"mohr-coulomb\""},
    {"unknown_volume_strain", "[grid]", "[numerics]\nvolume_strain = \"cell\"\n[grid]", 6,
     "[numerics] volume_strain: unknown word \"cell\"; accepted: \"point\" | \"cell-average\""},
    {"points_not_cubic", "points_per_cell = 8", "points_per_cell = 9", 35,
     "9 is out of range; accepted: 1 | 8 | 27 | 64"},
    {"zero_rocks", "count = 5", "count = 0", 39, "count: 0 is out of range"},
    {"empty_box", "[[0, 0, 0], [1, 1, 0.2]]", "[[0, 0, 0.2], [1, 1, 0.2]]", 34, "box: the box is empty"},
    {"slip_out_of_range", "slip = 0.3", "slip = 1.5", 57, "[phase.drive.drive] slip: 1.5 is out of range"},
    {"generator_kind", "kind = \"rock\"", "kind = \"rok\"", 31, "[shape.clast.generate] kind: unknown word \"rok\""},
    {"generator_key", "seed = 3", "sede = 3", 31, "[shape.clast.generate] sede: unknown key; did you mean \"seed\"?"},
    {"missing_key", "diameter = 0.05\n", "", 36,
     "[rocks[0]] diameter: missing; accepted: number >= 1e-06 and <= 100000 (m), or table"},
    {"missing_name", "name = \"sand\"\nmodel", "model", 7, "[material[0]] name: missing"},
    {"value_for_a_table", "[domain]\nsize = [1, 1.0, 1]\ngravity = [0, 0, -9.81]\n", "domain = 3\n", 2,
     "[domain]: wrong type: an integer; accepted: table"},
    {"gravity_of_a_black_hole", "-9.81]", "1e300]", 4,
     "[domain] gravity: element 2: 1e+300 is out of range; accepted: [x, y, z], each a number >= -10000 and <= 10000"},
    {"gravity_beyond_all_others", "-9.81]", "-1e308]", 4, "gravity: element 2: -1e+308 is out of range"},
    {"endless_phase", "max_duration = 1", "max_duration = 1e308", 53,
     "[phase.settle] max_duration: 1e+308 is out of range; accepted: number >= 1e-09 and <= 1e+10 (s)"},
    {"step_of_no_time", "[grid]", "[time]\ndt = 1e-30\n[grid]", 6,
     "[time] dt: 1e-30 is out of range; accepted: number >= 1e-12 and <= 1000, or \"auto\" (s)"},
    {"share_of_nothing", "[grid]", "[time]\ncontact_share = 1e-12\n[grid]", 6,
     "[time] contact_share: 1e-12 is out of range; accepted: number >= 0.001 and <= 0.8"},
    {"inertia_less_than_its_own", "[grid]", "[time]\nmass_scaling = 0.5\n[grid]", 6,
     "[time] mass_scaling: 0.5 is out of range; accepted: number >= 1 and <= 100"},
    {"too_many_substeps", "[grid]", "[time]\nsubsteps = 1_000_000_000\n[grid]", 6,
     "[time] substeps: 1000000000 is out of range; accepted: integer 1 to 100000"},
    {"grid_of_atoms", "spacing = 0.05", "spacing = 1e-12", 6,
     "[grid] spacing: 1e-12 is out of range; accepted: number >= 1e-06 and <= 100000 (m)"},
    {"too_many_checkpoints", "[grid]", "[checkpoint]\nkeep = 4600000000000000000\n[grid]", 6,
     "[checkpoint] keep: 4600000000000000000 is out of range; accepted: integer 1 to 10000"},
    {"too_many_snapshots", "[grid]", "[output]\nsnapshots_every = 1e-30\n[grid]", 6,
     "[output] snapshots_every: 1e-30 is out of range; accepted: 0, or number >= 1e-12 and <= 1e+12 (s)"},
    {"too_many_rows", "[grid]", "[output]\nevery = 1e-30\n[grid]", 6,
     "[output] every: 1e-30 is out of range; accepted: number >= 1e-12 and <= 1e+12 (s)"},
    {"body_at_the_end_of_the_world", "[0.5, 0.5, 0.6]", "[0.5, 0.5, 1e300]", 48, "position: 1e+300 is out of range"},
    {"single_bracket", "[[terrain]]", "[terrain]", 32, "[terrain]: wrong type: a table; accepted: [[terrain]]"},
};

const std::vector<BadCase> cross_cases{
    {"pic_rate_of_apic", "[grid]", "[numerics]\ntransfer = \"apic\"\npic_rate = 0.1\n[grid]", 7,
     "[numerics] pic_rate: may stand only with transfer = \"flip\""},
    {"stiff_wheel_and_walls", "young = 7e10\n", "", 21, "[material.steel] young: missing; perfectly stiff"},
    {"dilation_above_friction", "dilation_angle_deg = 5", "dilation_angle_deg = 31", 14,
     "dilation_angle_deg: 31 is above the friction angle; accepted: 0 to friction_angle_deg = 30 (degrees)"},
    {"friction_angle_of_elastic", "density = 2700.0", "density = 2700.0\nfriction_angle_deg = 3", 19,
     "[material.rock] friction_angle_deg: may stand only with model = \"mohr-coulomb\" or \"drucker-prager\" or "
     "\"drucker-prager-cap\""},
    {"cone_fit_of_mohr_coulomb", "poisson = 0.3", "poisson = 0.3\ndrucker_prager_fit = \"compression\"", 13,
     "[material.sand] drucker_prager_fit: may stand only with model = \"drucker-prager\" or \"drucker-prager-cap\""},
    {"cap_pressure_missing", "model = \"mohr-coulomb\"",
     "model = \"drucker-prager-cap\"\ndrucker_prager_fit = \"compression\"\ncap_index = 0.01", 7,
     "[material.sand] cap_pressure: missing; accepted: number >= 1 and <= 1e+12 (Pa)"},
    {"cap_index_of_mohr_coulomb", "poisson = 0.3", "poisson = 0.3\ncap_index = 0.01", 13,
     "[material.sand] cap_index: may stand only with model = \"drucker-prager-cap\""},
    {"softening_length_of_mohr_coulomb", "poisson = 0.3", "poisson = 0.3\nsoftening_length = 0.1", 13,
     "[material.sand] softening_length: may stand only with model = \"bolton\""},
    {"cone_fit_missing", "model = \"mohr-coulomb\"", "model = \"drucker-prager\"", 7,
     "[material.sand] drucker_prager_fit: missing; accepted: \"compression\" | \"extension\" | \"plane-strain\""},
    {"friction_angle_missing", "friction_angle_deg = 30\ndilation_angle_deg = 5\n", "", 7,
     "friction_angle_deg: missing"},
    {"young_missing", "young = 1e7\n", "", 15, "[material.rock] young: missing"},
    {"density_missing", "density = 2700.0\n", "", 15, "[material.rock] density: missing; terrain or rocks"},
    {"body_outside", "[0.5, 0.5, 0.6]", "[0.5, 1.5, 0.6]", 48,
     "[body.wheel] position: y = 1.5 is outside the domain; accepted: 0 to 1 (m)"},
    {"terrain_outside", "[1, 1, 0.2]]", "[1, 1.2, 0.2]]", 34, "[terrain[0]] region: the box leaves the domain along y"},
    {"rocks_outside", "[[0, 0, 0.1]", "[[-0.1, 0, 0.1]", 41, "[rocks[0]] region: the box leaves the domain along x"},
    {"unknown_material", "material = \"sand\"", "material = \"snad\"", 33,
     "there is no [[material]] called \"snad\"; did you mean \"sand\"?; accepted: sand, rock, steel"},
    {"unknown_shape", "shape = \"perseverance\"", "shape = \"perseverence\"", 45, "did you mean \"perseverance\"?"},
    {"unknown_rock_shape", "shape = \"clast\"", "shape = \"cube\"", 37,
     "[rocks[0]] shape: there is no [[shape]] called \"cube\""},
    {"rigid_terrain", "material = \"sand\"", "material = \"steel\"", 33,
     "the model of \"steel\" does not suit [[terrain]]"},
    {"plastic_rocks", "material = \"rock\"", "material = \"sand\"", 38,
     "the model of \"sand\" does not suit [[rocks]]"},
    {"plastic_body", "material = \"steel\"", "material = \"sand\"", 46, "the model of \"sand\" does not suit [[body]]"},
    {"two_materials_of_a_name", "[[contact]]",
     "[[material]]\nname = \"rock\"\nmodel = \"rigid\"\ndensity = 1\n[[contact]]", 27,
     "[material.rock] name: \"rock\" is also the name of [[material]] 1"},
    {"two_phases_of_a_name", "name = \"drive\"", "name = \"settle\"", 55, "\"settle\" is also the name of [[phase]] 0"},
    {"mass_twice", "mass = 10", "mass = 10\ndensity = 1", 47,
     "found density and mass; accepted: exactly one of density, mass, load"},
    {"no_mass", "mass = 10\n", "", 43, "[body.wheel] density: found none of them; accepted: exactly one of"},
    {"unknown_family", "[\"wheel\", \"sand\"]", "[\"weel\", \"sand\"]", 27,
     "there is no contact family called \"weel\"; did you mean \"wheel\"?"},
    {"reserved_family", "family = \"wheel\"\n[[contact]]\nbetween = [\"wheel\", \"sand\"]",
     "family = \"wall\"\n[[contact]]\nbetween = [\"rock\", \"sand\"]", 25, "\"wall\" is reserved"},
    {"sand_without_walls", "friction = 0.4",
     "friction = 0.4\n[[contact]]\nbetween = [\"sand\", \"wall\"]\ntouch = false", 31,
     "[contact[1]] touch: touch = false of [\"sand\", \"wall\"]: no rock or body is of this family, and sand always "
     "meets the walls; accepted: a pair with a family of rocks or bodies"},
    {"rocks_in_place_of_sand_that_they_do_not_touch", "friction = 0.4",
     "friction = 0.4\n[[contact]]\nbetween = [\"sand\", \"rock\"]\ntouch = false", 45,
     "[rocks[0]] placement: the rocks stand in place of sand, but [\"rock\", \"sand\"] do not touch in the first "
     "phase; "
     "accepted: \"rain\" | \"grid\", or touch = true in the first phase"},
    {"same_pair_twice", "friction = 0.4", "friction = 0.4\n[[contact]]\nbetween = [\"sand\", \"wheel\"]", 30,
     "[contact[1]] between: the same pair as [[contact]] 0"},
    {"walls_alone", "[\"wheel\", \"sand\"]", "[\"wall\", \"wall\"]", 27, "walls do not meet each other"},
    {"held_body_unknown", "hold = [\"wheel\"]", "hold = [\"weel\"]", 51,
     "[phase.settle] hold: there is no [[body]] called \"weel\""},
    {"driven_body_unknown", "body = \"wheel\"", "body = \"rover\"", 57,
     "[phase.drive] drive: there is no [[body]] called \"rover\""},
    {"held_and_driven", "duration = 2", "duration = 2\nhold = [\"wheel\"]", 58, "\"wheel\" is both held and driven"},
    {"slip_without_spin", "angular_velocity = 0.7", "angular_velocity = 0", 57, "angular_velocity is 0"},
    {"no_stop", "duration = 2\n", "", 54, "[phase.drive] duration: missing"},
    {"no_limit", "max_duration = 1\n", "", 49, "[phase.settle] max_duration: missing"},
    {"both_stops", "max_duration = 1", "max_duration = 1\nduration = 1", 54,
     "[phase.settle] duration: may stand only with until = \"duration\""},
    {"mesh_and_generator", "seed = 3 }", "seed = 3 }\nfile = \"bad.toml\"", 29,
     "found file and generate; accepted: exactly one of file, generate, assemble"},
    {"unit_of_generator", "seed = 3 }", "seed = 3 }\nunit = \"mm\"", 32, "unit: may stand only with `file`"},
    {"mesh_missing", "generate = { kind = \"rock\", seed = 3 }", "file = \"none.stl\"", 31,
     "[shape.clast] file: there is no file "},
    {"repair_is_no_number", "generate = { kind = \"rock\", seed = 3 }", "file = \"bad.toml\"\nrepair = 1", 32,
     "accepted: true | false"},
    {"wheel_without_room", "kind = \"rock\", seed = 3", "kind = \"wheel\", wall_thickness = 0.3", 31,
     "leave no room in the wheel"},
    {"grousers_overlap", "kind = \"rock\", seed = 3", "kind = \"wheel\", grousers = 900", 31, "the grousers overlap"},
    {"grouser_shape", "kind = \"rock\", seed = 3", "kind = \"wheel\", grouser_shape = \"zigzag\"", 31,
     "accepted: \"straight\" | \"chevron\" | \"curved\""},
    {"box_without_its_size", "kind = \"rock\", seed = 3", "kind = \"box\"", 31,
     "[shape.clast.generate] size: missing; accepted: [x, y, z], each a number >= 1e-06"},
    {"plate_round_and_square", "kind = \"rock\", seed = 3",
     "kind = \"plate\", radius = 1, size = [1, 1], thickness = 1", 31,
     "[shape.clast] generate: both radius and size; accepted: exactly one of radius, size"},
    {"plate_of_no_form", "kind = \"rock\", seed = 3", "kind = \"plate\", thickness = 1", 31, "neither radius nor size"},
    {"flat_cone", "kind = \"rock\", seed = 3", "kind = \"cone\", apex_angle_deg = 180, base_radius = 0.01", 31,
     "[shape.clast.generate] apex_angle_deg: 180 is out of range; accepted: number >= 5 and <= 170 (deg)"},
    {"shaft_wider_than_its_cone", "kind = \"rock\", seed = 3",
     "kind = \"cone\", base_radius = 0.01, shaft_radius = 0.02, shaft_length = 1", 31,
     "shaft_radius = 0.02 is more than the base; accepted: 0 to base_radius = 0.01 (m)"},
    {"shaft_without_length", "kind = \"rock\", seed = 3", "kind = \"cone\", base_radius = 0.01, shaft_radius = 0.01",
     31, "shaft_radius = 0.01 with shaft_length = 0; accepted: both, or neither, above 0"},
    {"ring_without_width", "kind = \"rock\", seed = 3",
     "kind = \"ring\", inner_radius = 0.1, outer_radius = 0.1, height = 0.01", 31,
     "inner_radius = 0.1 leaves no ring; accepted: at most 0.0999 (m) with outer_radius = 0.1"},
    {"vanes_of_no_height", "kind = \"rock\", seed = 3",
     "kind = \"ring\", inner_radius = 0.05, outer_radius = 0.1, height = 0.01, vanes = 8, vane_thickness = 0.002", 31,
     "[shape.clast.generate] vane_height: missing"},
    {"vanes_that_meet", "kind = \"rock\", seed = 3",
     "kind = \"ring\", inner_radius = 0.05, outer_radius = 0.1, height = 0.01, vanes = 8, vane_thickness = 0.04, "
     "vane_height = 0.01",
     31, "vane_thickness = 0.04: the vanes meet; accepted: at most 0.03444 (m) with 8 vanes at inner_radius = 0.05"},
    {"vane_height_without_vanes", "kind = \"rock\", seed = 3",
     "kind = \"ring\", inner_radius = 0.05, outer_radius = 0.1, height = 0.01, vane_height = 0.01", 31,
     "[shape.clast.generate] vane_height: may stand only with `vanes` over 0"},
    {"solid_tube", "kind = \"rock\", seed = 3", "kind = \"tube\", radius = 0.1, wall_thickness = 0.1, length = 1", 31,
     "wall_thickness = 0.1 is out of range; accepted: 0.0001 to 0.0999 (m) with radius = 0.1"},
    {"tray_filled_by_its_floor", "kind = \"rock\", seed = 3",
     "kind = \"frame\", inner_size = [0.1, 0.1], height = 0.05, wall_thickness = 0.01, floor_thickness = 0.05", 31,
     "floor_thickness = 0.05 fills the frame; accepted: below height = 0.05 (m)"},
    {"assembly_of_nothing", "generate = { kind = \"rock\", seed = 3 }", "assemble = []", 31,
     "[shape.clast] assemble: 0 parts; accepted: array of 1 to 100 tables"},
    {"assembly_of_one_table", "generate = { kind = \"rock\", seed = 3 }", "assemble = { shape = \"viper\" }", 31,
     "[shape.clast] assemble: wrong type: a table"},
    {"part_without_shape", "generate = { kind = \"rock\", seed = 3 }", "assemble = [ { at = [0, 0, 0] } ]", 31,
     "[shape.clast.assemble.0] shape: missing"},
    {"part_without_axis", "generate = { kind = \"rock\", seed = 3 }",
     "assemble = [ { shape = \"viper\" },\n{ shape = \"viper\", axis = [0, 0, 0] } ]", 32,
     "[shape.clast.assemble.1] axis: has no direction; accepted: [x, y, z], longer than 1e-6"},
    {"part_unknown", "generate = { kind = \"rock\", seed = 3 }", "assemble = [ { shape = \"vipper\" } ]", 31,
     "[shape.clast.assemble.0] shape: there is no shape called \"vipper\"; did you mean \"viper\"?"},
    {"assembly_of_itself", "generate = { kind = \"rock\", seed = 3 }", "assemble = [ { shape = \"clast\" } ]", 31,
     "[shape.clast.assemble.0] shape: \"clast\" would contain itself; accepted: a shape without this one in it"},
    {"assembly_and_generator", "seed = 3 }", "seed = 3 }\nassemble = [ { shape = \"viper\" } ]", 29,
     "found generate and assemble; accepted: exactly one of file, generate, assemble"},
    {"axis_and_yaw", "position = [0.5", "axis = [0, 0, 1]\nangle_deg = 3\nyaw_deg = 3\nposition = [0.5", 50,
     "[body.wheel] yaw_deg: found axis and angle_deg and yaw_deg; accepted: one of axis with angle_deg, rows, yaw_deg"},
    {"axis_without_angle", "position = [0.5", "axis = [0, 0, 1]\nposition = [0.5", 43,
     "[body.wheel] angle_deg: missing; `axis` needs it"},
    {"angle_without_axis", "position = [0.5", "angle_deg = 1\nposition = [0.5", 43,
     "[body.wheel] axis: missing; `angle_deg` needs it"},
    {"axis_of_no_length", "position = [0.5", "axis = [0, 0, 1e-9]\nangle_deg = 1\nposition = [0.5", 48,
     "[body.wheel] axis: has no direction"},
    {"rows_too_long", "position = [0.5", "rows = [[1, 0, 0], [0, 1, 0], [0, 0, 1.00001]]\nposition = [0.5", 48,
     "[body.wheel] rows: row 2 has a length of 1.00001; accepted: three rows [x, y, z], perpendicular unit vectors"},
    {"rows_askew", "position = [0.5", "rows = [[1, 0, 0], [0.6, 0.8, 0], [0, 0, 1]]\nposition = [0.5", 48,
     "[body.wheel] rows: rows 0 and 1 are not perpendicular: their product is 0.6"},
    {"rows_of_a_reflection", "position = [0.5", "rows = [[1, 0, 0], [0, 1, 0], [0, 0, -1]]\nposition = [0.5", 48,
     "[body.wheel] rows: the rows are left-handed"},
    {"gravity_twice", "gravity = [0, 0, -9.81]", "gravity = [0, 0, -9.81]\ngravity_size = 9.81", 4,
     "[domain] gravity: may stand only with `gravity_size` left out"},
    {"no_gravity", "gravity = [0, 0, -9.81]", "", 2, "[domain] gravity: missing; accepted: [x, y, z]"},
    {"slope_without_gravity", "gravity = [0, 0, -9.81]", "gravity = [0, 0, -9.81]\nslope_deg = 3", 5,
     "[domain] slope_deg: may stand only with `gravity_size` given"},
    {"gravity_below_zero", "gravity = [0, 0, -9.81]", "gravity_size = -9.81", 4,
     "[domain] gravity_size: -9.81 is out of range; accepted: number >= 0 and <= 10000 (m/s2)"},
    {"slope_beyond_a_wall", "gravity = [0, 0, -9.81]", "gravity_size = 9.81\nslope_deg = 91", 5,
     "[domain] slope_deg: 91 is out of range; accepted: number >= -90 and <= 90 (deg)"},
    {"coarse_grid", "spacing = 0.05", "spacing = 2", 6,
     "2 is more than the domain; accepted: number >= 1e-06 and <= 1 (m)"},
    {"too_many_cells", "size = [1, 1.0, 1]\ngravity = [0, 0, -9.81]\n[grid]\nspacing = 0.05",
     "size = [100, 1.0, 1]\ngravity = [0, 0, -9.81]\n[grid]\nspacing = 2e-5", 6,
     "[grid] spacing: 2e-05 gives 5e+06 cells along the domain's longest edge, over 262000; accepted: number >= "
     "0.00038"},
    {"no_spacing", "[grid]\nspacing = 0.05\n", "", 1, "[grid] spacing: missing; [[terrain]] needs it"},
    {"replace_without_terrain",
     "[[terrain]]\nmaterial = \"sand\"\nregion = { box = [[0, 0, 0], [1, 1, 0.2]] }\npoints_per_cell = 8\n", "", 38,
     "[rocks[0]] placement: \"replace\" needs a [[terrain]] to replace"},
};

std::string case_name(const ::testing::TestParamInfo<BadCase>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Key, BadInput, ::testing::ValuesIn(key_cases), case_name);
INSTANTIATE_TEST_SUITE_P(Cross, BadInput, ::testing::ValuesIn(cross_cases), case_name);

/// Shapes a, b, c, each an assembly of the next, and c of `last`.
std::string chain(const std::string& last)
{
    return good_scene +
           "[[shape]]\nname = \"a\"\nassemble = [ { shape = \"b\" } ]\n[[shape]]\nname = \"b\"\nassemble = [ "
           "{ shape = \"viper\" }, { shape = \"c\" } ]\n[[shape]]\nname = \"c\"\nassemble = [ { shape = \"" +
           last + "\" } ]\n";
}

TEST(BadInput, assemblies_in_a_circle)
{
    EXPECT_EQ(refusal(chain("clast")), "");
    EXPECT_THAT(refusal(chain("b")), HasSubstr("bad.toml:66: [shape.c.assemble.0] shape: \"b\" would contain itself"));
    EXPECT_THAT(refusal(chain("a")), HasSubstr("bad.toml:66: [shape.c.assemble.0] shape: \"a\" would contain itself"));
}

TEST(BadInput, assemblies_of_ever_more_parts)
{
    const auto text = [](int levels)
    {
        std::string scene = good_scene, ten;
        for (int i = 0; i < 10; ++i) { ten += (i > 0 ? ", " : "") + std::string("{ shape = \"LAST\" }"); }
        std::string last = "viper";
        for (int level = 0; level < levels; ++level)
        {
            std::string parts = ten;
            for (auto at = parts.find("LAST"); at != std::string::npos; at = parts.find("LAST"))
            {
                parts.replace(at, 4, last);
            }
            last = "level" + std::to_string(level);
            scene += "[[shape]]\nname = \"" + last + "\"\nassemble = [ " + parts + " ]\n";
        }
        return scene;
    };
    EXPECT_EQ(refusal(text(3)), "");
    // 10^4 parts in the fourth, on line 58 + 3 * 3 + 2.
    EXPECT_THAT(refusal(text(4)), HasSubstr("bad.toml:69: [shape.level3] assemble: its parts are over 1000"));
}

TEST(BadInput, places_of_points_without_terrain)
{
    const std::string terrain =
        "[[terrain]]\nmaterial = \"sand\"\nregion = { box = [[0, 0, 0], [1, 1, 0.2]] }\npoints_per_cell = 8\n";
    const auto bare = replaced(good_scene, terrain, "");
    EXPECT_THAT(refusal(replaced(bare, "placement = \"replace\"", "placement = \"points\"")),
                HasSubstr("bad.toml:38: [rocks[0]] placement: \"points\" needs a [[terrain]] to replace"));
}

TEST(BadInput, saved_bed_of_a_capped_material)
{
    const std::string cap = "model = \"drucker-prager-cap\"\ndrucker_prager_fit = \"compression\"\ncap_index = 0.01\n"
                            "cap_pressure = 1e4";
    const auto        capped = replaced(good_scene, "model = \"mohr-coulomb\"", cap);
    EXPECT_EQ(refusal(capped), "");
    const std::string made = "region = { box = [[0, 0, 0], [1, 1, 0.2]] }\npoints_per_cell = 8\n";
    EXPECT_THAT(refusal(replaced(capped, made, "from = \"bed.h5\"\n")),
                HasSubstr("[terrain[0]] from: a saved bed has no pressure of the cap of \"sand\""));
}

TEST(BadInput, stiffness_that_grows_from_none)
{
    const auto stiffens = replaced(good_scene, "young = 1e6", "young = 1e6\nyoung_pressure = 2e4");
    EXPECT_EQ(refusal(stiffens), "");
    EXPECT_THAT(
        refusal(replaced(stiffens, "dilation_angle_deg = 5", "cohesion = 10")),
        HasSubstr("[material.sand] young_pressure: stiffness grows from none, but cohesion is 10 Pa; accepted: 0 "
                  "(Pa), or cohesion = 0"));
    EXPECT_THAT(refusal(replaced(stiffens, "model = \"mohr-coulomb\"", "model = \"elastic\"")),
                HasSubstr("[material.sand] young_pressure: may stand only with model = \"mohr-coulomb\" or "
                          "\"drucker-prager\" or \"bolton\""));
}

TEST(BadInput, softening_lengths)
{
    const auto dense = replaced(replaced(good_scene, "model = \"mohr-coulomb\"",
                                         "model = \"bolton\"\nrelative_density = 0.8\nvoid_ratio_min = 0.5\n"
                                         "void_ratio_max = 0.9\nsoftening_length = 0.05"),
                                "dilation_angle_deg = 5\n", "");
    EXPECT_EQ(refusal(dense), "");
    const auto expect = [&](const char* before, const char* after, const char* message)
    { EXPECT_THAT(refusal(replaced(dense, before, after)), HasSubstr(message)); };
    expect("softening_length = 0.05", "softening_length = 0.04",
           "[material.sand] softening_length: 0.04 is less than a cell, so that it would have no effect; "
           "accepted: number >= [grid] spacing = 0.05 (m)");
    expect("softening_length = 0.05", "nonlocal_weight = 2",
           "[material.sand] nonlocal_weight: may stand only with softening_length given");
    expect("spacing = 0.05", "spacing = 0.05\nrefine = [[[0.3, 0.3, 0.0], [0.7, 0.7, 0.2]]]",
           "softening_length: the mean does not cross the seams of a refined grid; accepted: no [grid] refine");
    expect("[[terrain]]", "[sleep]\ndistance = 0.2\n[[terrain]]",
           "softening_length: the mean would miss sand that sleeps; accepted: no [sleep] distance");
    expect("[[contact]]",
           "[[material]]\nname = \"loose\"\nmodel = \"bolton\"\ndensity = 1500.0\nyoung = 1e6\n"
           "friction_angle_deg = 30\nrelative_density = 0.2\nvoid_ratio_min = 0.5\nvoid_ratio_max = 0.9\n"
           "softening_length = 0.1\n[[contact]]",
           "softening_length: 0.05 differs from that of \"loose\"; accepted: 0.1 (m), one length for all materials");
}

TEST(BadInput, all_errors_come_at_once_in_the_order_of_the_file)
{
    auto text          = replaced(good_scene, "young = 1e6", "young = -1");
    text               = replaced(text, "count = 5", "count = \"five\"");
    text               = replaced(text, "gravity", "gravitty");
    const auto message = refusal(text);
    // gravity is missing in its table (2) and unknown at its place in the file (4)
    const std::vector<std::string> expected{"bad.toml:2: [domain] gravity: missing", "bad.toml:4: [domain] gravitty",
                                            "bad.toml:11: [material.sand] young", "bad.toml:39: [rocks[0]] count"};
    std::size_t                    place = 0;
    for (const auto& line : expected)
    {
        place = message.find(line, place);
        ASSERT_NE(place, std::string::npos) << line << " is not in its place in\n" << message;
    }
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 3) << message;
}

TEST(BadInput, an_empty_array_of_tables_is_none)
{
    const auto message = refusal("phase = []\nbody = []\n[domain]\nsize = [1, 1, 1]\ngravity = [0, 0, 0]\n");
    EXPECT_THAT(message, HasSubstr("at least one [[phase]]"));
    EXPECT_THAT(message, HasSubstr("the scene is empty"));
}

TEST(BadInput, load_without_gravity)
{
    auto text = replaced(good_scene, "mass = 10", "load = 10");
    EXPECT_EQ(refusal(text), "");
    text = replaced(text, "-9.81]", "0]");
    EXPECT_THAT(refusal(text), HasSubstr("bad.toml:47: [body.wheel] load: a load needs gravity"));
}

TEST(BadInput, a_capital_letter_is_recognised)
{
    const auto text = replaced(good_scene, "mass = 10", "mass = 10\nlock = [\"Y\"]");
    EXPECT_THAT(refusal(text), HasSubstr("lock: element 0: unknown word \"Y\"; did you mean \"y\"?"));
    EXPECT_THAT(refusal(replaced(text, "\"Y\"", "\"w\"")), HasSubstr("unknown word \"w\"; accepted: "));
    EXPECT_THAT(refusal(replaced(good_scene, "\"elastic\"", "\"Elastic\"")), HasSubstr("did you mean \"elastic\"?"));
}

TEST(BadInput, good_scene_is_good) { EXPECT_EQ(refusal(good_scene), ""); }

} // namespace
} // namespace tread::scene::test
