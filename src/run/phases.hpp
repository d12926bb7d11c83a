#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "solver/body_command.hpp"
#include "world/world.hpp"

namespace tread::solver
{
class StateFile;
}

namespace tread::run
{

enum class EndKind
{
    running,
    duration,  ///< ran for as long as it was to
    settled,   ///< in equilibrium
    unsettled, ///< was to reach equilibrium, and did not within its max_duration
    lowered,   ///< the ground carries what was to be lowered
    unlowered, ///< it did not within the phase's max_duration
    end_of_bed ///< the driven body got to where the bed ends
};

/// In summary.json: "duration", "not settled".
const char* name_of(EndKind kind);
EndKind     end_kind(const std::string& name);

/// Whether the phase did not reach what it was for, or was cut short.
bool deserves_warning(EndKind kind);

/// How a phase ended.
struct PhaseEnd
{
    EndKind kind       = EndKind::running;
    double  after      = 0; ///< s, since the phase began; of a settled one, with the time that equilibrium had to hold
    double  unbalanced = 0; ///< force that is out of balance over the weight, at the end

    std::string body    = {}; ///< that was lowered
    double      carried = 0;  ///< share of its weight that contacts carry at the end
    std::string place   = {}; ///< that a drive got to
};

/// For the log: "settled after ..."
std::string describe(const PhaseEnd& end);

/// The share of a body's weight that contacts carry: a mean over the recent past, in which what lies d back counts
/// exp(-d / span).
struct CarriedShare
{
    /// The integral (s) over time of that share until `time`, from any start on.
    void note(double time, double integral);

    /// Contacts come and go: points of sand touch one after the other, and the touch sends waves through the bed, of
    /// some 10 ms to its floor and back. A mean over that much follows the load of sinking into sand to some percent (a
    /// wheel that sinks 40 mm under its weight is lowered in 0.8 s at 0.05 m/s), and on hard ground, which
    /// takes the whole load within less, what is stored in the contact when the mean has reached the weight throws the
    /// body up by no more than speed times span: 0.5 mm.
    static constexpr double span = 0.01; ///< s

    double last    = -1; ///< s, when it was last noted; negative = never
    double carried = 0;  ///< s, then
    double share   = 0;
};

/// Which phase runs, since when, and what it asks for. Times in s of simulated time.
class PhaseClock
{
public:
    /// `rolling_radii`: of the named bodies, m.
    PhaseClock(const scene::Scene& scene, std::vector<double> rolling_radii);

    const scene::Phase& phase() const { return scene_.phases[index_]; }
    std::size_t         index() const { return index_; }
    double              start() const { return start_; }
    bool                finished() const { return index_ == scene_.phases.size(); }

    /// Simulated time at which the phase ends at the latest.
    double latest_end() const;

    /// True when the phase is over at `time`; `unbalanced` = the share of the weight that is out of balance.
    /// Equilibrium wants it under equilibrium_ratio during equilibrium_hold of the phase's time without a break.
    /// Lowering wants what weigh() was told.
    bool over(double time, double unbalanced);

    /// The named body that the present phase lowers.
    std::optional<std::size_t> lowered() const;

    /// Of lowered(): the integral (s) over time of the share of its weight that contacts carried until `time`.
    void weigh(double time, double carried) { carried_.note(time, carried); }

    /// The phase is over at `time` because its drive got to `place`.
    void end_of_bed(double time, double unbalanced, const std::string& place);

    /// Enters the next phase; `spins` = the named bodies' present angular velocity about their axle, rad/s.
    void advance(double time, std::vector<double> spins);

    /// What the present phase asks of named body `body` at `time`.
    solver::BodyCommand command(std::size_t body, double time) const;

    /// Of the phase that over() was last asked about.
    const PhaseEnd& ending() const { return ending_; }

    static constexpr double equilibrium_ratio = 1e-2;
    static constexpr double equilibrium_hold  = 0.05; ///< s

    /// Into a checkpoint, or out of it.
    void transfer(solver::StateFile& file);

private:
    solver::BodyCommand lower() const;
    double              weight(std::size_t body, double time) const;
    solver::BodyCommand motion(std::size_t body, double time) const;

    const scene::Scene& scene_;
    std::vector<double> rolling_radii_;
    std::size_t         index_ = 0;
    double              start_ = 0;
    double              still_since_;
    CarriedShare        carried_;
    std::vector<double> start_spins_;
    PhaseEnd            ending_;
};

/// Bits of dem::LockedFreedom for the words x y z roll pitch yaw.
std::uint32_t locked_freedoms(const std::vector<std::string>& words);

/// Radius (m) that slip is measured with: the body's rolling_radius, or the wheel's over its grousers. `scale` is that
/// of the body.
double rolling_radius(const scene::Body& body, const shape::ShapeTemplate& form, double scale);

/// Of all named bodies.
std::vector<double> rolling_radii(const scene::Scene& scene, const world::World& world);

} // namespace tread::run
