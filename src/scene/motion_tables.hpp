#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scene/document.hpp"
#include "scene/problems.hpp"
#include "scene/scene.hpp"

// Courses and tables over time of the motions of phases.
namespace tread::scene
{

/// A course of a motion that has one, and its key.
struct NamedCourse
{
    const char*   key;
    const Course& course;
};

/// Courses of the axes with a velocity, force or torque, and of the load.
std::vector<NamedCourse> courses_of(const Motion& motion);

/// Makes the paths of tables absolute and reads them. Reports what is wrong with a table at the key that names it.
void complete_motions(Scene& scene, const Node& document, Problems& problems);

/// Calls add(path, key) for each table of a motion.
void add_motion_files(const Scene& scene, const std::function<void(const std::string&, const std::string&)>& add);

} // namespace tread::scene
