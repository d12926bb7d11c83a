#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/summary.hpp"
#include "scene/scene.hpp"

// Results of a run for its named bodies, computed from its time series.
namespace tread::run
{

/// Computes the answers of each named body, in the scene's order: for every phase that drives or lowers it and has
/// begun; if there is none, for the last phase that does not hold it. `path`: timeseries.h5. `ended`: number of phases
/// that have ended.
std::vector<io::BodyAnswers> make_answers(const scene::Scene& scene, const std::string& path, std::size_t ended);

/// Sets the grid errors of the answers of the last driven wheel, in all phases that drive it.
void add_grid_error(const scene::Scene& scene, const io::GridError& error, std::vector<io::BodyAnswers>& answers);

/// Means of the last drive of the last driven wheel; empty if it has not begun.
std::optional<io::DriveMeans> last_drive(const scene::Scene& scene, const std::vector<io::BodyAnswers>& answers);

/// A line for each phase: "answers: wheel, drive: pull 154 +- 3 N (0.15 of the load), ..., steady over 1.5 to 3 s".
std::vector<std::string> answer_lines(const std::vector<io::BodyAnswers>& answers);

} // namespace tread::run
