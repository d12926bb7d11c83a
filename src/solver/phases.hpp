#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "solver/world.hpp"

namespace tread::solver
{

class StateFile;

/// What a phase asks of one named body at one time.
struct BodyCommand
{
    std::uint32_t         locked = 0; ///< bits of dem::LockedFreedom
    std::optional<double> spin;       ///< rad/s about the axle
    std::optional<double> forward;    ///< m/s along x

    bool operator==(const BodyCommand&) const = default;
};

enum class EndKind
{
    running,
    duration, ///< ran for as long as it was to
    settled,  ///< in equilibrium
    unsettled ///< was to reach equilibrium, and did not within its max_duration
};

/// How a phase ended.
struct PhaseEnd
{
    EndKind kind       = EndKind::running;
    double  after      = 0; ///< s, since the phase began; of a settled one, with the time that equilibrium had to hold
    double  unbalanced = 0; ///< force that is out of balance over the weight, at the end
};

/// For the log: "settled after ..."
std::string describe(const PhaseEnd& end);

/// Which phase runs, since when, and what it asks for. Times in s of simulated time.
class PhaseClock
{
public:
    explicit PhaseClock(const scene::Scene& scene);

    const scene::Phase& phase() const { return scene_.phases[index_]; }
    std::size_t         index() const { return index_; }
    double              start() const { return start_; }
    bool                finished() const { return index_ == scene_.phases.size(); }

    /// Simulated time at which the phase ends at the latest.
    double latest_end() const;

    /// True when the phase is over at `time`; `unbalanced` = the share of the weight that is out of balance.
    /// Equilibrium wants it under equilibrium_ratio during equilibrium_hold of the phase's time without a break.
    bool over(double time, double unbalanced);

    /// Enters the next phase; `spins` = the named bodies' present angular velocity about their axle, rad/s.
    void advance(double time, std::vector<double> spins);

    /// What the present phase asks of named body `body` at `time`.
    BodyCommand command(std::size_t body, double time) const;

    /// Of the phase that over() was last asked about.
    const PhaseEnd& ending() const { return ending_; }

    static constexpr double equilibrium_ratio = 1e-2;
    static constexpr double equilibrium_hold  = 0.05; ///< s

    /// Into a checkpoint, or out of it.
    void transfer(StateFile& file);

private:
    const scene::Scene& scene_;
    std::size_t         index_ = 0;
    double              start_ = 0;
    double              still_since_;
    std::vector<double> start_spins_;
    PhaseEnd            ending_;
};

/// Bits of dem::LockedFreedom for the words x y z roll pitch yaw.
std::uint32_t locked_freedoms(const std::vector<std::string>& words);

/// Radius (m) that slip is measured with: the body's rolling_radius, or the wheel's over its grousers. `scale` is that
/// of the body.
double rolling_radius(const scene::Body& body, const shape::ShapeTemplate& form, double scale);

} // namespace tread::solver
