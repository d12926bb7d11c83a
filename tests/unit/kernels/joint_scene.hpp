#pragma once

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "dem_scene.hpp"
#include "kernels/dem/joints/joints.hpp"
#include "kernels/dem/joints/make_joint.hpp"

// A few jointed bodies without contacts, for tests of joints against closed forms.
namespace tread::test
{

inline constexpr std::int32_t world = dem::joint_world;

/// A joint of a test: its kind, bodies, place, and parts as they stand in `numbers`.
struct Tie
{
    dem::JointKind              kind;
    std::array<std::int32_t, 2> bodies;
    Vec3<double>                at;
    Vec3<double>                axis    = Vec3<double>::UnitY();
    dem::Joint                  numbers = {};                   ///< parts and their numbers
    Vec3<double>                to      = Vec3<double>::Zero(); ///< of a spring: its point on b

    std::array<std::int32_t, 2> couples = {}; ///< of a differential
};

inline std::vector<dem::Joint> joints_of(const std::vector<Solid>& solids, const std::vector<Tie>& ties)
{
    std::vector<Vec3<double>> positions;
    std::vector<Quat>         orientations;
    for (const Solid& solid : solids)
    {
        positions.push_back(solid.position);
        orientations.push_back(solid.orientation);
    }
    std::vector<dem::Joint> joints;
    for (const Tie& tie : ties)
    {
        const dem::JointPlace place{{tie.at, tie.kind == dem::joint_spring ? tie.to : tie.at}, tie.axis};
        dem::Joint            joint = tie.kind == dem::joint_differential
                                          ? dem::make_differential(tie.couples)
                                          : dem::make_joint(tie.kind, tie.bodies, place, positions, orientations);
        joint.parts                 = tie.numbers.parts;
        joint.stiffness             = tie.numbers.stiffness;
        joint.damping               = tie.numbers.damping;
        joint.rest                  = tie.numbers.rest;
        joint.low                   = tie.numbers.low;
        joint.high                  = tie.numbers.high;
        joint.speed                 = tie.numbers.speed;
        joint.most_effort           = tie.numbers.most_effort;
        joint.gain                  = tie.numbers.gain;
        joints.push_back(joint);
    }
    return joints;
}

inline dem::Joint spring(double stiffness, double damping, double rest)
{
    dem::Joint numbers{};
    numbers.parts     = dem::joint_has_spring;
    numbers.stiffness = stiffness;
    numbers.damping   = damping;
    numbers.rest      = rest;
    return numbers;
}

inline dem::Joint motor(double speed, double most_effort, double gain = 0)
{
    dem::Joint numbers{};
    numbers.parts       = dem::joint_has_motor;
    numbers.speed       = speed;
    numbers.most_effort = most_effort;
    numbers.gain        = gain;
    return numbers;
}

inline dem::Joint limits(double low, double high)
{
    dem::Joint numbers{};
    numbers.parts = dem::joint_has_limits;
    numbers.low   = low;
    numbers.high  = high;
    return numbers;
}

/// A slender rod along its own x axis, at an angle about y (positive: its +x end goes down).
inline Solid rod(double length, double mass, const Vec3<double>& centre, double tilt = 0)
{
    Solid        solid;
    const double across = mass * length * length / 12;
    solid.mass          = mass;
    solid.inertia       = Vec3<double>(across / 100, across, across).asDiagonal();
    solid.position      = centre;
    solid.orientation   = Quat(Eigen::AngleAxisd(tilt, Vec3<double>::UnitY()));
    return solid;
}

template<class Exec>
class JointScene
{
public:
    JointScene(const Exec& exec, const std::vector<Solid>& solids, const std::vector<Tie>& ties,
               const Vec3<double>& gravity = {0, 0, -9.81})
        : solids_(exec, {unit_sphere(0, 12)}, solids, numbers_with(gravity))
        , joints_(exec, joints_of(solids, ties), static_cast<std::int64_t>(solids.size()))
        , exec_(exec)
    {
    }

    /// Moves by `count` substeps of dt under gravity, joints and the given wrenches.
    void run(double dt, std::int64_t count, const dem::OutsideWrenches& outside = {})
    {
        dem::BodyStep<Exec> step = solids_.step(dt, 0, outside);
        step.joints              = joints_.view();
        for (std::int64_t i = 0; i < count; ++i) { dem::move_bodies(exec_, step); }
    }

    Vec3<double> position(std::int64_t b) { return read(exec_, solids_.bodies.position.data() + b); }
    Vec3<double> velocity(std::int64_t b) { return read(exec_, solids_.bodies.velocity.data() + b); }
    Vec3<double> spin(std::int64_t b) { return read(exec_, solids_.bodies.angular_velocity.data() + b); }
    Quat         orientation(std::int64_t b) { return read(exec_, solids_.bodies.orientation.data() + b); }

    dem::JointRecord record(std::size_t j) { return joints_.records()[j]; }
    void             clear_records() { joints_.clear_records(); }
    dem::BodySums    sums() { return solids_.sums(); }
    double           energy()
    {
        const dem::BodySums now = sums();
        return now.kinetic + now.potential;
    }

    /// m and rad, largest errors of all joints since the records were cleared.
    std::pair<double, double> errors()
    {
        std::pair<double, double> largest{0, 0};
        for (const dem::JointRecord& record : joints_.records())
        {
            largest.first  = std::max(largest.first, record.gap);
            largest.second = std::max(largest.second, record.misalignment);
        }
        return largest;
    }

private:
    static SolidNumbers numbers_with(const Vec3<double>& gravity)
    {
        SolidNumbers numbers;
        numbers.gravity = gravity;
        return numbers;
    }

    SolidScene<Exec>  solids_;
    dem::Joints<Exec> joints_;
    Exec              exec_;
};

} // namespace tread::test
