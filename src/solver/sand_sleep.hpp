#pragma once

#include "kernels/mpm/laws/material_parameters.hpp"
#include "kernels/mpm/pages/leaving.hpp"
#include "scene/scene.hpp"
#include "solver/page_watch.hpp"
#include "solver/sand_report.hpp"
#include "world/world.hpp"

namespace tread::solver
{

/// The sand of one rank that sleeps: whole pages whose points stand apart from those of the steps, with stress and
/// without velocity, and so cost nothing. The nodes that they reach are held.
template<class Exec, class Real>
class SandSleep
{
public:
    /// The scene must have sleep.distance.
    SandSleep(const Exec& exec, const scene::Scene& scene, const world::World& world, mpm::PointFields fields);

    /// Those that sleep.
    mpm::Points<Exec, Real>&       points() { return points_; }
    const mpm::Points<Exec, Real>& points() const { return points_; }

    /// Of those that sleep.
    const SandCensus& census() const { return census_; }

    /// A step of dt (s) was taken.
    void pass(double dt);

    /// Points that slept so far, over time.
    double mean_count() const { return lived_ > 0 ? slept_ / lived_ : 0; }

    /// At each measuring: peaks[point page][mpm::PointPeak].
    void note(const double* peaks) { watch_.note(peaks); }

    /// Whether it is time to look who may sleep, where nothing is faster than `speed` (m/s). With damping none may.
    bool is_due(double speed, double damping) const;

    /// Looks. Points, listed in `pages`, fall asleep and others wake: says if any did, and then all have to be ordered
    /// anew. With damping none may. Materials: by PointsView::material.
    bool look(mpm::Points<Exec, Real>& points, const mpm::Pages<Exec>& pages, const mpm::GridGeometry& geometry,
              const std::vector<BodyReach>& bodies, const mpm::MaterialParameters<Real>* materials,
              mpm::OrderScratch<Exec, Real>& scratch, double damping);

    /// Before pages are made anew, and after.
    void leave_pages() { watch_.collect(held_); }
    void enter_pages(const mpm::Pages<Exec>& pages, const mpm::PagesView& view, SortScratch<Exec>& scratch);

    /// The last of what the grid does in a step.
    void hold(const mpm::PagesView& pages, const Real* tiles, const mpm::GridStep<Real>& step, Real* motion,
              double* tallies);

    /// N s, what stopped points that fell asleep since the last call.
    Vec3<double> take_impulse();

    /// Into a checkpoint, or out of it; then the pages are those that were entered last. Points go by themselves.
    void transfer(StateFile& file, const mpm::Pages<Exec>& pages, const mpm::PagesView& view,
                  SortScratch<Exec>& scratch);

private:
    void       move(mpm::Points<Exec, Real>& from, mpm::Points<Exec, Real>& to,
                    const std::vector<std::uint64_t>& pages_to_move, const mpm::GridGeometry& geometry,
                    mpm::OrderScratch<Exec, Real>& scratch, const mpm::MaterialParameters<Real>* materials,
                    SandCensus& moved);
    SandCensus census_of_leaving(mpm::Points<Exec, Real>& points, const mpm::MaterialParameters<Real>* materials);
    void       stop(std::int64_t first);

    Exec                       exec_;
    RestRule                   rule_;
    double                     load_limit_; ///< N a page
    mpm::Points<Exec, Real>    points_;
    std::vector<std::uint64_t> asleep_; ///< keys of pages, ascending
    Array<Exec, std::uint64_t> asleep_key_;
    mpm::HeldPages<Exec>       held_;
    mpm::Leaving<Exec>         leaving_;
    PageWatch<Exec>            watch_;
    SandCensus                 census_;
    Vec3<double>               impulse_ = Vec3<double>::Zero();
    double                     slept_   = 0; ///< s, summed over points
    double                     lived_   = 0; ///< s
};

} // namespace tread::solver
