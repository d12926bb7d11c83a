#pragma once

#include <array>
#include <string_view>

#include "scene/scene.hpp"
#include "scene/table.hpp"

// The one table of all keys of a scene. Reading, validation, writing and docs/scene.md iterate it.
namespace tread::scene
{

/// Wheels that a body may use as its shape without a [[shape]] table.
inline constexpr std::array<std::string_view, 4> builtin_wheels{"perseverance", "curiosity", "spirit", "viper"};

/// Contact family of the domain's walls.
inline constexpr std::string_view wall_family = "wall";

Keys<Scene>       scene_keys();
Keys<Domain>      domain_keys();
Keys<GridOptions> grid_keys();
Keys<TimeOptions> time_keys();
Keys<Numerics>    numerics_keys();
Keys<Material>    material_keys();
Keys<Contact>     contact_keys();
Keys<Shape>       shape_keys();
Keys<Terrain>     terrain_keys();
Keys<Rocks>       rocks_keys();
Keys<Body>        body_keys();
Keys<Joint>       joint_keys(); // joint_keys.cpp
Keys<Phase>       phase_keys();
Keys<Output>      output_keys();
Keys<Balance>     balance_keys();
Keys<Sleep>       sleep_keys();
Keys<Reference>   reference_keys();

Keys<CheckpointOptions> checkpoint_keys();

/// Keys of position and size, shared by [[terrain]] and [[rocks]] (bed_keys.cpp).
Key<Terrain> terrain_region_key();
Key<Terrain> terrain_height_key();
Key<Terrain> terrain_floor_key();
Key<Rocks>   rocks_region_key();
Key<Rocks>   rocks_height_key();
Key<Rocks>   rocks_floor_key();
Key<Rocks>   rocks_diameter_key();

/// Generator of a [[shape]], with the keys of each kind (generator_keys.cpp).
Key<Shape> generate_key();

/// Prescribed motions of a [[phase]], and the name of one in messages (motion_keys.cpp). `phase`: the phase's name
/// there.
Keys<Motion> motion_keys();
Key<Phase>   phase_motion_key();
std::string  motion_label(const std::string& phase, std::size_t index);

/// Settings of motors in a [[phase]] (joint_keys.cpp).
Key<Phase> phase_motors_key();

/// Calls visit(name, meaning, member pointer, keys) for each table of a scene, in the order of writing. A member that
/// is a vector is an array of tables.
template<class Visit>
void for_each_table(Visit&& visit)
{
    visit("domain", "The box [0, size] in which everything happens, and its walls.", &Scene::domain, domain_keys());
    visit("grid", "The background grid of the material points.", &Scene::grid, grid_keys());
    visit("time", "Steps of the time loop.", &Scene::time, time_keys());
    visit("numerics", "Choices of method.", &Scene::numerics, numerics_keys());
    visit("material", "A material of terrain, rocks or bodies.", &Scene::materials, material_keys());
    visit("contact", "Friction and restitution of one pair of contact families, and whether they touch.",
          &Scene::contacts, contact_keys());
    visit("shape", "A rigid shape, made once and shared by all its instances.", &Scene::shapes, shape_keys());
    visit("terrain", "A region filled with material points.", &Scene::terrain, terrain_keys());
    visit("rocks", "A set of rigid rocks of one shape.", &Scene::rocks, rocks_keys());
    visit("body", "A single rigid body, such as a wheel.", &Scene::bodies, body_keys());
    visit("joint", "A joint between two rigid bodies, or a body and the world: docs/theory.md#joints.", &Scene::joints,
          joint_keys());
    visit("phase", "A span of simulated time; phases run in the order given.", &Scene::phases, phase_keys());
    visit("output", "What is written while the run goes on.", &Scene::output, output_keys());
    visit("checkpoint", "When the state is written to `checkpoints/`, for `--restart`: docs/restart.md.",
          &Scene::checkpoint, checkpoint_keys());
    visit("balance", "How the sand falls to the ranks of a run on several: docs/ranks.md.", &Scene::balance,
          balance_keys());
    visit("sleep",
          "Sand that lies still far from what moves is left out of the steps, if `distance` is given, and rocks at "
          "rest, if `rock_speed` is: docs/sleep.md.",
          &Scene::sleep, sleep_keys());
    visit("reference", "The right answer, as far as it is known, for `tread study`: docs/study.md. Changes no run.",
          &Scene::reference, reference_keys());
}

} // namespace tread::scene
