#pragma once

#include <cstdint>

#include "backend/array.hpp"
#include "backend/sort.hpp"
#include "kernels/contact/point_body_kern.hpp"
#include "kernels/contact/runs.hpp"
#include "kernels/dem/bodies.hpp"
#include "kernels/dem/templates.hpp"
#include "kernels/mpm/pages/pages.hpp"
#include "kernels/mpm/points.hpp"

// Which sand points may touch which body during one MPM step, or several: found once, frozen during the substeps.
namespace tread::contact
{

/// How far things may move before the candidates are found again.
struct SearchReach
{
    double dt;             ///< s, of the MPM step
    double point_speed;    ///< m/s, no point is faster
    double point_drift;    ///< m, how far a point may stand outside the cell that it is listed in
    double largest_radius; ///< m, of any point
    double sampled_below;  ///< m, PointBodyLaw's
    double skin;           ///< m, twice the way that a body and a point may at least come nearer: room for more steps
};

/// (body, point) pairs, ordered by body; within a body by page and memory order.
struct CandidatesView
{
    std::int64_t        count;
    const std::int32_t* body;
    const std::int32_t* point;    ///< index in memory: valid until the points are ordered again
    const std::int32_t* touched;  ///< run in by_point of the candidate's point
    const std::int32_t* in_order; ///< candidates ordered by point, then by body
};

/// Owner of what CandidatesView shows, its runs, and the scratch of the search.
template<class Exec>
struct Candidates
{
    explicit Candidates(const Exec& exec)
        : body(exec, "candidate body")
        , point(exec, "candidate point")
        , touched(exec, "candidate touched point")
        , in_order(exec, "candidates by point")
        , by_body(exec, "touched bodies", "touched body first candidate")
        , by_point(exec, "touched points", "touched point first candidate")
        , body_parts(exec)
        , sort(exec)
        , box_first(exec, "contact page boxes")
        , pair_first(exec, "contact pages found")
        , pair_body(exec, "contact page body")
        , pair_page(exec, "contact page")
        , cell_first(exec, "contact cells found")
        , marks(exec, "contact run marks")
        , sorted_points(exec, "contact sorted points")
        , sort_keys(exec, "contact sort keys")
    {
    }

    CandidatesView view() const { return {body.size(), body.data(), point.data(), touched.data(), in_order.data()}; }

    Array<Exec, std::int32_t> body;
    Array<Exec, std::int32_t> point;
    Array<Exec, std::int32_t> touched;
    Array<Exec, std::int32_t> in_order;
    Runs<Exec>                by_body;    ///< over the candidates
    Runs<Exec>                by_point;   ///< over in_order
    Parts<Exec>               body_parts; ///< of by_body

    SortScratch<Exec>          sort;
    Array<Exec, std::int32_t>  box_first;
    Array<Exec, std::int32_t>  pair_first;
    Array<Exec, std::int32_t>  pair_body;
    Array<Exec, std::int32_t>  pair_page;
    Array<Exec, std::int32_t>  cell_first;
    Array<Exec, std::int32_t>  marks;
    Array<Exec, std::int32_t>  sorted_points;
    Array<Exec, std::uint64_t> sort_keys;
};

/// Every (body, point) pair that can come into contact within the step. A pair is kept when the point lies in the
/// body's bounding box and under its signed distance, both grown by r_p, by the skin or twice what body and point can
/// move if that is more, and by the reach of the point's samples: the trilinear interpolant of a distance rises by at
/// most sqrt(3) a metre.
template<class Exec, class Real>
void find_candidates(const Exec& exec, Candidates<Exec>& candidates, const mpm::PointsView<Real>& points,
                     const mpm::PagesView& pages, const dem::BodiesView& bodies, const dem::TemplateView* templates,
                     RadiusRule radius, const SearchReach& reach);

/// The order of the candidates by point, and the runs of both orders, of body and point as find_candidates leaves them.
template<class Exec>
void order_by_point(const Exec& exec, Candidates<Exec>& candidates);

} // namespace tread::contact
