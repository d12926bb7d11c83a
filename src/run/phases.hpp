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
    duration,  ///< ran for its whole duration
    settled,   ///< in equilibrium
    unsettled, ///< did not reach equilibrium within its max_duration
    lowered,   ///< the ground carries the lowered body
    unlowered, ///< it does not within the phase's max_duration
    end_of_bed ///< the driven body reached the end of the bed
};

/// Name in summary.json: "duration", "not settled".
const char* name_of(EndKind kind);
EndKind     end_kind(const std::string& name);

/// Whether the phase missed its goal, or was cut short.
bool deserves_warning(EndKind kind);

/// How a phase ended.
struct PhaseEnd
{
    EndKind kind  = EndKind::running;
    double  after = 0; ///< s since the phase began; if settled, includes the time for which equilibrium had to hold
    double  unbalanced = 0; ///< unbalanced force over the weight, at the end

    std::string body    = {}; ///< body that was lowered
    double      carried = 0;  ///< share of its weight that contacts carry at the end
    std::string place   = {}; ///< end that a drive reached
};

/// Describes the end for the log: "settled after ..."
std::string describe(const PhaseEnd& end);

/// Share of a body's weight that contacts carry: an exponential mean, in which a value d ago has weight exp(-d /
/// span).
struct CarriedShare
{
    /// Adds the integral (s) of that share over time until `time`, counted from any start.
    void note(double time, double integral);

    /// Contacts are intermittent: sand points touch one after the other, and each touch sends waves through the bed,
    /// of some 10 ms to its floor and back. A mean over that time follows the load during sinking into sand to some
    /// percent. Hard ground takes the whole load within less; the energy stored in the contact when the mean reaches
    /// the weight then throws the body up by at most speed times span: 0.5 mm at 0.05 m/s.
    static constexpr double span = 0.01; ///< s

    double last    = -1; ///< s, time of the last note(); negative = never
    double carried = 0;  ///< s, integral at that time
    double share   = 0;
};

/// The running phase, its start, and its commands. Times in s of simulated time.
class PhaseClock
{
public:
    /// `rolling_radii`: m, of the named bodies.
    PhaseClock(const scene::Scene& scene, std::vector<double> rolling_radii);

    const scene::Phase& phase() const { return scene_.phases[index_]; }
    std::size_t         index() const { return index_; }
    double              start() const { return start_; }
    bool                finished() const { return index_ == scene_.phases.size(); }

    /// Latest simulated time at which the phase ends.
    double latest_end() const;

    /// Whether the phase is over at `time`; `unbalanced` = unbalanced force over the weight. Equilibrium requires it
    /// below equilibrium_ratio for equilibrium_hold of the phase's time without a break. Lowering uses the values of
    /// weigh().
    bool over(double time, double unbalanced);

    /// Index of the named body that the present phase lowers.
    std::optional<std::size_t> lowered() const;

    /// Adds, for lowered(), the integral (s) over time of the share of its weight that contacts carried until `time`.
    void weigh(double time, double carried) { carried_.note(time, carried); }

    /// Ends the phase at `time` because its drive reached `place`.
    void end_of_bed(double time, double unbalanced, const std::string& place);

    /// Enters the next phase; `spins`: rad/s, present angular velocities of the named bodies about their axles.
    void advance(double time, std::vector<double> spins);

    /// Command of the present phase to named body `body` at `time`.
    solver::BodyCommand command(std::size_t body, double time) const;

    /// End of the phase for which over() was last called.
    const PhaseEnd& ending() const { return ending_; }

    static constexpr double equilibrium_ratio = 1e-2;
    static constexpr double equilibrium_hold  = 0.05; ///< s

    /// Saves to a checkpoint, or loads from it.
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

/// Converts the words x y z roll pitch yaw to bits of dem::LockedFreedom.
std::uint32_t locked_freedoms(const std::vector<std::string>& words);

/// Radius (m) on which slip is based: the body's rolling_radius, or the wheel's including its grousers. `scale`: the
/// body's.
double rolling_radius(const scene::Body& body, const shape::ShapeTemplate& form, double scale);

/// Rolling radii (m) of all named bodies.
std::vector<double> rolling_radii(const scene::Scene& scene, const world::World& world);

} // namespace tread::run
