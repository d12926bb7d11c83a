#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

// Prescribed motion of a body in a phase, as plain data; motion_keys.cpp reads it.
namespace tread::scene
{

/// A column of a CSV file over the time of a phase; linear between rows.
struct TimeTable
{
    std::string path;
    std::string column;

    std::vector<double> time;  ///< s since the phase began, increasing; read when the scene is loaded
    std::vector<double> value; ///< at these times

    /// Whether the same column is meant.
    bool operator==(const TimeTable& other) const { return path == other.path && column == other.column; }
};

/// A quantity over the time of a phase: a value that is reached by a linear ramp, or a table.
struct Course
{
    double                   value = 0;
    std::optional<double>    from;     ///< at the start of the ramp; empty: the velocity at the start, or no force
    double                   ramp = 0; ///< s
    std::optional<TimeTable> table;

    bool operator==(const Course&) const = default;
};

enum class AxisKind
{
    free,
    held,
    velocity, ///< m/s or rad/s
    effort    ///< force (N) or torque (N m)
};

struct AxisMotion
{
    AxisKind kind = AxisKind::free;
    Course   course;

    bool operator==(const AxisMotion&) const = default;
};

/// Axes of a motion.
enum class MotionFrame
{
    world,
    body ///< the body's axes when the phase begins; they do not turn with it
};

/// Vertical spring and damper between a body and a carriage.
struct Carriage
{
    double stiffness = 0; ///< N/m
    double damping   = 0; ///< N s/m
    double height    = 0; ///< m, z of the centre of mass at which the spring is at rest

    bool operator==(const Carriage&) const = default;
};

/// Values that end the phase; empty: none.
struct MotionStop
{
    std::array<std::optional<double>, 3> force;        ///< N, contact force along an axis, in either direction
    std::array<std::optional<double>, 3> displacement; ///< m, since the phase began, in either direction

    bool operator==(const MotionStop&) const = default;
};

struct Motion
{
    std::string               body;
    MotionFrame               frame          = MotionFrame::world; ///< of x y z
    MotionFrame               rotation_frame = MotionFrame::world; ///< of roll pitch yaw
    std::array<AxisMotion, 3> translation;                         ///< x y z
    std::array<AxisMotion, 3> rotation;                            ///< roll pitch yaw
    AxisMotion                axle;                                ///< rotation about the body's own y axis
    double                    axle_friction = 0;                   ///< N m
    std::optional<Course>     load;                                ///< N, downwards, in place of the body's weight
    std::optional<Carriage>   carriage;
    std::optional<MotionStop> until;

    bool operator==(const Motion&) const = default;
};

inline constexpr std::array<const char*, 3> translation_axes{"x", "y", "z"};
inline constexpr std::array<const char*, 3> rotation_axes{"roll", "pitch", "yaw"};

} // namespace tread::scene
