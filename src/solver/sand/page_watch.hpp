#pragma once

#include <map>

#include "base/communicator.hpp"
#include "kernels/mpm/grid/held_pages.hpp"
#include "solver/sand/page_rest.hpp"

namespace tread::solver
{

class StateFile;

/// Observes pages of sand between two sleep checks: speeds on awake pages, and the forces that hold sleeping ones.
template<class Exec>
class PageWatch
{
public:
    explicit PageWatch(const Exec& exec);

    /// s, time since the last check.
    double window() const { return window_; }

    /// Records a step of dt (s).
    void pass(double dt);

    /// Records the largest speeds of the steps since the last call: peaks[point page][mpm::PointPeak].
    void note(const double* peaks);

    /// Copies the records to the host before pages are renumbered; synchronises.
    void collect(mpm::HeldPages<Exec>& held);

    /// Sets the pages to observe from now on; call after collect.
    void follow(const mpm::Pages<Exec>& pages, const mpm::HeldPages<Exec>& held);

    /// Lists the pages that hold points of this rank, keys ascending; call after collect. Speeds over `speed` (m/s) are
    /// not at rest.
    std::vector<AwakePage> awake(const mpm::Pages<Exec>& pages, double speed) const;

    /// Records how long the awake pages of all ranks have been at rest, and forgets all others.
    void remember(const std::vector<AwakePage>& awake);

    /// Tells all ranks how fast pages have been since the last check; call after collect, before pages get other
    /// owners. Collective.
    void tell_ranks(const Communicator& communicator);

    /// Lists sleeping pages whose load has changed by more than `force` (N per page) since they were first held, keys
    /// ascending; call after collect.
    std::vector<std::uint64_t> pressed(double force);

    /// Records pages that wake between two checks.
    void note_woken(const std::vector<std::uint64_t>& pages);

    /// Begins the time window of the next check.
    void begin_window() { window_ = 0; }

    void transfer(StateFile& file, mpm::HeldPages<Exec>& held);

private:
    /// Record of a page that holds points.
    struct Rest
    {
        double speed_squared = 0; ///< m2/s2, largest since the last check
        double quiet         = 0; ///< s, time at rest at the last check
        double late          = 0; ///< s, part of this window before it woke
    };

    /// Load of a held page.
    struct Load
    {
        double       windows = 0;                    ///< number of checks for which it was held in the same way
        Vec3<double> first   = Vec3<double>::Zero(); ///< N, mean over the first of these windows
        Vec3<double> impulse = Vec3<double>::Zero(); ///< N s, since the last check
        double       time    = 0;                    ///< s, since the last check
    };

    struct Held
    {
        std::uint8_t octants = 0;
        Load         load;
    };

    Exec                          exec_;
    Array<Exec, double>           speeds_; ///< [point pages], m2/s2
    std::vector<std::uint64_t>    keys_;   ///< keys of the point pages
    std::vector<std::uint64_t>    held_keys_;
    std::map<std::uint64_t, Rest> rest_;
    std::map<std::uint64_t, Held> held_;
    double                        window_      = 0;
    double                        uncollected_ = 0; ///< s
};

} // namespace tread::solver
