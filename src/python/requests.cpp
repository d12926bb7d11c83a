#include "python/requests.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "base/errors.hpp"
#include "run/agreement.hpp"

namespace tread::python
{
namespace
{

/// The word's place in a list; Python has checked it.
template<class Word, std::size_t n>
Word word_of(const Json& request, const char* key, const std::array<const char*, n>& words)
{
    const auto word = request.at(key).get<std::string>();
    for (std::size_t i = 0; i < n; ++i)
    {
        if (word == words[i]) { return static_cast<Word>(i); }
    }
    throw InputError(std::string(key) + ": unknown word '" + word + "'");
}

run::RestartOptions restart_of(const std::string& word)
{
    if (word == "none") { return {run::RestartMode::none, ""}; }
    if (word == "auto") { return {run::RestartMode::automatic, ""}; }
    return {run::RestartMode::file, word};
}

/// JSON has no numbers that are not finite.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json numbers(const Vec3<double>& v) { return {number(v[0]), number(v[1]), number(v[2])}; }

std::optional<double> optional_number(const Json& request, const char* key)
{
    const Json& value = request.at(key);
    return value.is_null() ? std::nullopt : std::optional<double>(value.get<double>());
}

Json time_json(const run::VisitTime& when)
{
    return {{"time", when.time},
            {"steps", when.steps},
            {"last_dt", when.last_dt},
            {"phase", when.phase},
            {"since_phase", when.since_phase},
            {"over", when.over}};
}

Json body_json(const run::VisitedBody& body)
{
    const solver::BodyRow& row = body.row;
    const Quat&            q   = row.orientation;
    return {{"position", numbers(row.position)},
            {"orientation", {q.w(), q.x(), q.y(), q.z()}},
            {"velocity", numbers(row.velocity)},
            {"angular_velocity", numbers(row.angular_velocity)},
            {"axle", numbers(row.axle)},
            {"spin", solver::spin_of(row)},
            {"lowest", row.lowest},
            {"force", numbers(body.force)},
            {"impulse", numbers(body.impulse)},
            {"mass", number(body.mass)},
            {"rolling_radius", body.rolling_radius}};
}

Json joint_json(const solver::JointRow& joint)
{
    return {{"coordinate", joint.coordinate},
            {"motor_torque", joint.motor_torque},
            {"force", numbers(joint.force)},
            {"torque", numbers(joint.torque)}};
}

run::BodySteering body_steering(const Json& request)
{
    return {optional_number(request, "spin"), optional_number(request, "forward"),
            request.at("force").get<std::array<double, 3>>(), request.at("torque").get<std::array<double, 3>>(),
            request.at("axle_torque").get<double>()};
}

run::MotorSteering motor_steering(const Json& request)
{
    return {request.at("speed").get<double>(), optional_number(request, "max_torque")};
}

} // namespace

scene::Scene scene_of(const Communicator& communicator, const Json& request)
{
    const Json& source    = request.at("scene");
    const auto  overrides = source.at("overrides").get<std::vector<std::string>>();
    if (source.contains("path"))
    {
        return run::load_on_every_rank(communicator, source.at("path").get<std::string>(), overrides);
    }
    const scene::SceneText text{source.at("text").get<std::string>(), source.at("name").get<std::string>(),
                                source.at("directory").get<std::string>()};
    return run::load_on_every_rank(communicator, text, overrides);
}

run::RunOptions options_of(const Json& request)
{
    run::RunOptions options;
    options.output         = request.at("output").get<std::string>();
    options.scene_file     = request.at("scene").value("path", "");
    options.existing       = request.at("existing") == "overwrite" ? io::Existing::overwrite : io::Existing::refuse;
    options.backend        = word_of<run::BackendChoice>(request, "backend", std::array{"auto", "cpu", "cuda"});
    options.threads        = request.at("threads").get<int>();
    options.restart        = restart_of(request.at("restart").get<std::string>());
    options.walltime_limit = request.at("walltime_limit").get<double>();
    return options;
}

MPI_Comm communicator_of(const Json& request)
{
    const Json& handle = request.at("communicator");
    return handle.is_null() ? MPI_COMM_WORLD : MPI_Comm_f2c(handle.get<MPI_Fint>());
}

std::string answer(run::Visit& visit, const Json& request)
{
    const auto what = request.at("what").get<std::string>();
    if (what == "when") { return time_json(visit.when()).dump(); }
    const auto name = request.at("name").get<std::string>();
    if (what == "body") { return body_json(visit.body(name)).dump(); }
    if (what == "joint") { return joint_json(visit.joint(name)).dump(); }
    if (what == "steer body") { visit.steer(name, body_steering(request)); }
    else { visit.steer(name, motor_steering(request)); }
    return "null";
}

} // namespace tread::python
