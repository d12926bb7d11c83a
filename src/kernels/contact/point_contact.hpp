#pragma once

#include <cstdint>

#include "kernels/contact/candidates.hpp"
#include "kernels/contact/history.hpp"
#include "kernels/contact/summary.hpp"
#include "kernels/dem/motion/outside.hpp"

// Sand against rigid bodies during one MPM step: begin_step or begin_kept_step, N times substep, finish_step. During
// the substeps each point in reach moves on a private copy of (x, v); only the accumulated impulse goes back to the
// sand.
namespace tread::contact
{

/// What the private copies do during the substeps.
enum class PointMotion : std::int32_t
{
    supported, ///< feel the contact and are held up by the acceleration that the grid gave them last step
    ballistic, ///< feel the contact alone
    frozen,    ///< stay where they are, at their grid velocity (the paper's)
};

/// Numbers and tables of the law that hold for the whole scene.
struct PointBodyLaw
{
    const dem::TemplateView* templates;
    dem::PairTable           pairs;
    double                   hertz_factor; ///< 1, or 1/sqrt(2) for the paper's Eq. 7
    RadiusRule               radius;
    PointMotion              motion;
    double                   sampled_below; ///< m, equivalent radius under which points take nine samples; 0 = never
};

/// Private copies of the points in reach: one for each run of Candidates::by_point.
struct PrivatePoints
{
    std::int64_t   count;
    Vec3<double>*  position; ///< m
    Vec3<double>*  velocity; ///< m/s
    Vec3<double>*  support;  ///< m/s2
    Vec3<double>*  impulse;  ///< N s, of the step so far
    double*        mass;     ///< kg
    double*        radius;   ///< m
    std::int32_t*  material;
    std::uint32_t* id;
};

/// State of the candidates, in their order. A candidate has one slot of history, or one for each sample.
struct ContactsView
{
    CandidatesView      candidates;
    const std::int32_t* slot_first; ///< [count + 1], or null: one each
    Tangential*         tangential; ///< of the slots
    Response*           response;   ///< of the last substep
    double*             dissipated; ///< J, friction, since summarise or begin_step

    TREAD_HD std::int64_t first_slot(std::int64_t c) const { return slot_first == nullptr ? c : slot_first[c]; }
};

/// Owner of everything that the sand-body contact needs.
template<class Exec>
struct PointContact
{
    explicit PointContact(const Exec& exec)
        : candidates(exec)
        , history(exec)
        , position(exec, "private point position")
        , velocity(exec, "private point velocity")
        , support(exec, "private point support")
        , impulse(exec, "private point impulse")
        , mass(exec, "private point mass")
        , radius(exec, "private point radius")
        , material(exec, "private point material")
        , id(exec, "private point id")
        , slot_first(exec, "contact slots")
        , tangential(exec, "contact tangential")
        , response(exec, "contact response")
        , dissipated(exec, "contact dissipated")
        , run_of_body(exec, "contact run of body")
        , wrench_sums(exec, "contact wrench sums")
        , summary_sums(exec, "contact summary sums")
        , summary(exec, "contact summary")
        , all_parts(exec, "contact parts as one run")
        , marks(exec, "contact history marks")
    {
    }

    PrivatePoints private_points()
    {
        return {position.size(), position.data(), velocity.data(), support.data(), impulse.data(),
                mass.data(),     radius.data(),   material.data(), id.data()};
    }

    ContactsView contacts()
    {
        return {candidates.view(), slot_first.data(), tangential.data(), response.data(), dissipated.data()};
    }

    /// On the bodies, of the last substep.
    dem::OutsideWrenches wrenches() const
    {
        if (candidates.body.size() == 0) { return {}; }
        return {run_of_body.data(), candidates.body_parts.first_of_run.data(), wrench_sums.data()};
    }

    Candidates<Exec> candidates;
    History<Exec>    history;

    Array<Exec, Vec3<double>>  position;
    Array<Exec, Vec3<double>>  velocity;
    Array<Exec, Vec3<double>>  support;
    Array<Exec, Vec3<double>>  impulse;
    Array<Exec, double>        mass;
    Array<Exec, double>        radius;
    Array<Exec, std::int32_t>  material;
    Array<Exec, std::uint32_t> id;

    Array<Exec, std::int32_t> slot_first; ///< empty where no body takes samples
    Array<Exec, Tangential>   tangential;
    Array<Exec, Response>     response;
    Array<Exec, double>       dissipated;

    Array<Exec, std::int32_t>       run_of_body;  ///< of Candidates::by_body; -1 = no candidates
    Array<Exec, dem::ContactWrench> wrench_sums;  ///< one for each part of a touched body's candidates
    Array<Exec, Summary>            summary_sums; ///< the same
    Array<Exec, Summary>            summary;      ///< of all
    Array<Exec, std::int32_t>       all_parts;    ///< first and end of wrench_sums
    Array<Exec, std::int32_t>       marks;
};

/// Finds the candidates, copies their points (velocity from grid_velocity, impulse zero), and keeps and recalls the
/// history. The points must be coupled (PointFields) and listed in `pages`.
template<class Exec, class Real>
void begin_step(const Exec& exec, PointContact<Exec>& contact, const mpm::PointsView<Real>& points,
                const mpm::PagesView& pages, const dem::BodiesView& bodies, const PointBodyLaw& law,
                const SearchReach& reach);

/// The same with the candidates, and their history, that the last begin_step found: for as long as nothing has come
/// nearer to each other than its reach allowed and points stand where they stood in memory. Allocates nothing.
template<class Exec, class Real>
void begin_kept_step(const Exec& exec, PointContact<Exec>& contact, const mpm::PointsView<Real>& points,
                     const PointBodyLaw& law);

/// Forces of all candidates at the present places of points and bodies: contact.wrenches() for the bodies, which the
/// caller moves; then the private points move by dt (s, of the substep). Allocates nothing.
template<class Exec>
void substep(const Exec& exec, PointContact<Exec>& contact, const dem::BodiesView& bodies, const PointBodyLaw& law,
             double dt);

/// points.contact_force = impulse / dt (s, of the MPM step) for points in reach, zero for the others.
template<class Exec, class Real>
void finish_step(const Exec& exec, PointContact<Exec>& contact, const mpm::PointsView<Real>& points, double dt);

/// Puts what the pairs that carry a tangential force remember under their keys in contact.history: for the next search,
/// which does so itself, or for others.
template<class Exec>
void keep_history(const Exec& exec, PointContact<Exec>& contact);

/// Of candidates that were loaded (contact.candidates.body and point): all that begin_step makes of these but what the
/// points are, which begin_kept_step copies, and what the pairs remember, which the caller puts into
/// contact.tangential.
template<class Exec>
void resume_candidates(const Exec& exec, PointContact<Exec>& contact, const dem::BodiesView& bodies,
                       const PointBodyLaw& law);

/// Of the last substep (dissipated: since the last summary or begin_step), where there are candidates; live_named
/// counts contacts of the first `named` bodies. Returns where the backend will have it.
template<class Exec>
const Summary* summarise(const Exec& exec, PointContact<Exec>& contact, std::int64_t named);

} // namespace tread::contact
