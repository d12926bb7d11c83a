#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "run/steering.hpp"
#include "solver/bodies/body_joints.hpp"
#include "solver/bodies/body_row.hpp"

// Visits to a run by the program that has called it: between two steps it reads the state and steers named bodies.
namespace tread::run
{

enum class NumberKind : std::int32_t
{
    floating,
    integer,
    natural
};

/// A table of numbers in host memory. A scalar field has one column.
struct HostArray
{
    const void*  data        = nullptr;
    NumberKind   kind        = NumberKind::floating;
    std::int32_t bytes       = 0; ///< of a number
    std::int64_t rows        = 0;
    std::int64_t columns     = 1;
    std::int64_t row_step    = 0; ///< bytes
    std::int64_t column_step = 0; ///< bytes
};

/// When a visit takes place. Times in s.
struct VisitTime
{
    double       time    = 0;
    std::int64_t steps   = 0;
    double       last_dt = 0;
    std::string  phase;               ///< of the last phase when the run is over
    double       since_phase = 0;     ///< since the phase began
    bool         over        = false; ///< all phases ran; nothing can be steered
};

/// A named body. Force and torque of `row` are means since the last row of the time series, 0 right after one.
struct VisitedBody
{
    solver::BodyRow row;
    Vec3<double>    impulse;        ///< N s, of its contacts since the run began
    Vec3<double>    force;          ///< N, of its contacts, mean since the last visit; 0 in the first
    double          mass;           ///< kg
    double          rolling_radius; ///< m
};

/// State of a run between two steps, valid during the visit. On several ranks all make the same calls, and what rank 0
/// sets counts. InputError for a name that the scene lacks.
class Visit
{
public:
    Visit()                        = default;
    Visit(const Visit&)            = delete;
    Visit& operator=(const Visit&) = delete;
    virtual ~Visit()               = default;

    virtual VisitTime        when() const                   = 0;
    virtual VisitedBody      body(const std::string& name)  = 0;
    virtual solver::JointRow joint(const std::string& name) = 0;

    /// A field by its name (VisitedArrays); empty if the scene does not have it.
    virtual std::optional<HostArray> field(const std::string& name) = 0;

    /// Sets what a named body does until this is called again or the phase ends. InputError where the phase does not
    /// let it (require_steerable).
    virtual void steer(const std::string& body, const BodySteering& wish) = 0;

    /// Likewise for the motor of a joint.
    virtual void steer(const std::string& joint, const MotorSteering& wish) = 0;
};

/// The calling program as a run sees it.
struct Visitor
{
    /// Called at the first measured step of each phase, at those at or past each span, and when all phases ran. A
    /// returned reason stops the run after a checkpoint. Empty: no visits.
    std::function<std::optional<std::string>(Visit&)> visit;
    double                                            every       = 0; ///< s simulated, a span; 0 = none
    std::int64_t                                      every_steps = 0; ///< likewise in steps

    std::function<bool()> stop_asked;   ///< asked between steps and within long ones; empty: never
    std::function<bool()> keeps_memory; ///< whether fields are still read after their visit: the run must not free them
};

/// Deletes what has fields, unless the visitor goes on reading them.
struct DeleteUnlessKept
{
    const Visitor& visitor;

    template<class T>
    void operator()(T* object) const
    {
        if (!visitor.keeps_memory || !visitor.keeps_memory()) { delete object; }
    }
};

} // namespace tread::run
