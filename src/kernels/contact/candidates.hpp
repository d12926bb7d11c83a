#pragma once

#include <cstdint>

#include "backend/array.hpp"
#include "backend/sort.hpp"
#include "kernels/contact/point_body_kern.hpp"
#include "kernels/contact/runs.hpp"
#include "kernels/dem/bodies.hpp"
#include "kernels/dem/pairs/displacement_limit.hpp"
#include "kernels/dem/templates.hpp"
#include "kernels/mpm/pages/pages.hpp"
#include "kernels/mpm/points.hpp"

// Candidates: sand points that may touch one or several bodies during an MPM step. They are found once and constant
// during the substeps.
namespace tread::contact
{

/// Allowed motion until the candidates are found again.
struct SearchReach
{
    double dt;             ///< s, of the MPM step
    double point_speed;    ///< m/s, upper bound of the points' speeds
    double point_drift;    ///< m, maximum distance of a point from the cell in which it is listed
    double largest_radius; ///< m, maximum radius of the points
    double sampled_below;  ///< m, as in PointBodyLaw
    double skin;           ///< m, Verlet skin: twice the least approach of body and point that the list allows

    dem::ListedPlaces listed = {}; ///< bodies may use what this allows them, too
};

/// View of the (body, point) pairs, ordered by body; within a body by page and memory order.
struct CandidatesView
{
    std::int64_t        count;
    const std::int32_t* body;
    const std::int32_t* point;    ///< index in memory, valid until the points are reordered
    const std::int32_t* touched;  ///< run of the candidate's point in by_point
    const std::int32_t* in_order; ///< candidates ordered by point, then by body
};

/// Memory of CandidatesView with its runs, and scratch memory of the search.
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
        , pair_box(exec, "contact cells of a page")
        , first_cell(exec, "contact cells")
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
    Array<Exec, std::int32_t>  pair_box;   ///< PageCells of each pair of body and page, packed
    Array<Exec, std::int32_t>  first_cell; ///< of each such pair, and their end
    Array<Exec, std::int32_t>  cell_first; ///< first candidate of each cell, and their end
    Array<Exec, std::int32_t>  marks;
    Array<Exec, std::int32_t>  sorted_points;
    Array<Exec, std::uint64_t> sort_keys;
};

/// Finds every (body, point) pair that can come into contact within the step. A pair is kept if the point lies in the
/// body's bounding box and its signed distance is below a bound. Both are extended by r_p, by the skin (or by twice the
/// possible displacement of body and point if that is larger), and by twice what the list of pairs allows the body and
/// the extent of the point's samples: the slope of the trilinear interpolant of a distance is at most sqrt(3). Pairs of
/// materials that do not touch have no candidates.
template<class Exec, class Real>
void find_candidates(const Exec& exec, Candidates<Exec>& candidates, const mpm::PointsView<Real>& points,
                     const mpm::PagesView& pages, const dem::BodiesView& bodies, const dem::TemplateView* templates,
                     const dem::PairTable& materials, RadiusRule radius, const SearchReach& reach);

/// Builds the order of the candidates by point and the runs of both orders, from body and point as find_candidates
/// leaves them.
template<class Exec>
void order_by_point(const Exec& exec, Candidates<Exec>& candidates);

} // namespace tread::contact
