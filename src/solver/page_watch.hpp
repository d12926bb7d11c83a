#pragma once

#include <map>

#include "kernels/mpm/grid/held_pages.hpp"
#include "solver/page_rest.hpp"

namespace tread::solver
{

class StateFile;

/// What happens to the pages of the sand between two looks at which of them may sleep: how fast the awake ones move,
/// and what the sand beside the sleeping ones holds them with.
template<class Exec>
class PageWatch
{
public:
    explicit PageWatch(const Exec& exec);

    /// s, since the last look.
    double window() const { return window_; }

    /// A step of dt (s) was taken.
    void pass(double dt);

    /// The largest speeds of the steps since the last call: peaks[point page][mpm::PointPeak].
    void note(const double* peaks);

    /// Brings to the host what was noted of pages that are about to be numbered anew; waits for it.
    void collect(mpm::HeldPages<Exec>& held);

    /// After that: of these pages from now on.
    void follow(const mpm::Pages<Exec>& pages, const mpm::HeldPages<Exec>& held);

    /// After collect: the pages that hold points, keys ascending. Over `speed` (m/s) is not at rest.
    std::vector<AwakePage> awake(const mpm::Pages<Exec>& pages, double speed);

    /// After collect: sleeping pages whose load is another by more than `force` (N a page) than when they were first
    /// held, keys ascending.
    std::vector<std::uint64_t> pressed(double force);

    /// The look is over.
    void begin_window() { window_ = 0; }

    void transfer(StateFile& file, mpm::HeldPages<Exec>& held);

private:
    /// Of a page that holds points.
    struct Rest
    {
        double speed_squared = 0; ///< m2/s2, largest since the last look
        double quiet         = 0; ///< s, at the last look
    };

    /// Of a held page.
    struct Load
    {
        double       windows = 0;                    ///< looks for which it was held in the same way
        Vec3<double> first   = Vec3<double>::Zero(); ///< N, mean of the first of them
        Vec3<double> impulse = Vec3<double>::Zero(); ///< N s, since the last look
        double       time    = 0;                    ///< s, since then
    };

    struct Held
    {
        std::uint8_t octants = 0;
        Load         load;
    };

    Exec                          exec_;
    Array<Exec, double>           speeds_; ///< [point pages], m2/s2
    std::vector<std::uint64_t>    keys_;   ///< of the point pages
    std::vector<std::uint64_t>    held_keys_;
    std::map<std::uint64_t, Rest> rest_;
    std::map<std::uint64_t, Held> held_;
    double                        window_      = 0;
    double                        uncollected_ = 0; ///< s
};

} // namespace tread::solver
