#pragma once

#include <cstdint>

#include "kernels/contact/candidates.hpp"
#include "kernels/contact/history.hpp"
#include "kernels/contact/summary.hpp"
#include "kernels/dem/motion/outside.hpp"

// Contact of sand and rigid bodies during one MPM step: begin_step or begin_kept_step, N times substep, finish_step.
// During the substeps each candidate point moves on a private copy of (x, v); only the accumulated impulse is returned
// to the sand.
namespace tread::contact
{

/// Motion of the private copies during the substeps.
enum class PointMotion : std::int32_t
{
    supported, ///< move under the contact force and the grid acceleration of the last step
    ballistic, ///< move under the contact force alone
    frozen,    ///< keep their position and their grid velocity (as in the paper)
};

/// Parameters and tables of the contact law that hold for the whole scene.
struct PointBodyLaw
{
    const dem::TemplateView* templates;
    dem::PairTable           pairs;
    double                   hertz_factor; ///< 1, or 1/sqrt(2) for the paper's Eq. 7
    RadiusRule               radius;
    PointMotion              motion;
    double sampled_below; ///< m, equivalent radius below which nine samples represent a point; 0 = never
};

/// Private copies of the candidate points, one for each run of Candidates::by_point.
struct PrivatePoints
{
    std::int64_t   count;
    Vec3<double>*  position; ///< m
    Vec3<double>*  velocity; ///< m/s
    Vec3<double>*  support;  ///< m/s2
    Vec3<double>*  impulse;  ///< N s, accumulated in this step
    double*        mass;     ///< kg
    double*        radius;   ///< m
    std::int32_t*  material;
    std::uint32_t* id;
};

/// State of the candidates, in their order. A candidate has one slot of history, or one per sample.
struct ContactsView
{
    CandidatesView      candidates;
    const std::int32_t* number;     ///< of each body in the scene; null: that of its row
    const std::int32_t* slot_first; ///< [count + 1]; null: one slot each
    Tangential*         tangential; ///< per slot
    Response*           response;   ///< of the last substep
    double*             dissipated; ///< J, dissipated by friction since summarise or begin_step

    TREAD_HD std::int64_t first_slot(std::int64_t c) const { return slot_first == nullptr ? c : slot_first[c]; }

    /// Number of the candidate's body in the scene.
    TREAD_HD std::int32_t body_number(std::int64_t c) const
    {
        return number == nullptr ? candidates.body[c] : number[candidates.body[c]];
    }
};

/// Memory of the sand-body contact.
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
        , number(exec, "contact body numbers")
        , slot_first(exec, "contact slots")
        , tangential(exec, "contact tangential")
        , response(exec, "contact response")
        , dissipated(exec, "contact dissipated")
        , run_of_body(exec, "contact run of body")
        , wrench_sums(exec, "contact wrench sums")
        , summary_sums(exec, "contact summary sums")
        , summary(exec, "contact summary")
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
        return {candidates.view(), number.data(),   slot_first.data(),
                tangential.data(), response.data(), dissipated.data()};
    }

    /// Returns the wrenches on the bodies of the last substep.
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

    Array<Exec, std::int32_t> number;     ///< of the bodies when candidates were found; empty where it is their row
    Array<Exec, std::int32_t> slot_first; ///< empty if no body takes samples
    Array<Exec, Tangential>   tangential;
    Array<Exec, Response>     response;
    Array<Exec, double>       dissipated;

    Array<Exec, std::int32_t>       run_of_body;  ///< of Candidates::by_body; -1 = no candidates
    Array<Exec, dem::ContactWrench> wrench_sums;  ///< one per part of a touched body's candidates
    Array<Exec, Summary>            summary_sums; ///< of chunks of the contacts
    Array<Exec, Summary>            summary;      ///< of all contacts
    Array<Exec, std::int32_t>       marks;
};

/// Finds the candidates, copies their points (velocity from grid_velocity, impulse zero), saves the contact history and
/// restores it for the new candidates. The points must be coupled (PointFields) and listed in `pages`.
template<class Exec, class Real>
void begin_step(const Exec& exec, PointContact<Exec>& contact, const mpm::PointsView<Real>& points,
                const mpm::PagesView& pages, const dem::BodiesView& bodies, const PointBodyLaw& law,
                const SearchReach& reach);

/// Begins a step with the candidates and histories of the last begin_step: valid while nothing has approached by more
/// than its search allowed and the points are not reordered in memory. Allocates nothing.
template<class Exec, class Real>
void begin_kept_step(const Exec& exec, PointContact<Exec>& contact, const mpm::PointsView<Real>& points,
                     const PointBodyLaw& law);

/// Computes the forces of all candidates at the present positions of points and bodies (contact.wrenches() for the
/// bodies, which the caller integrates), then moves the private points by dt (s, of the substep). Allocates nothing.
template<class Exec>
void substep(const Exec& exec, PointContact<Exec>& contact, const dem::BodiesView& bodies, const PointBodyLaw& law,
             double dt);

/// Sets points.contact_force to impulse / dt (s, of the MPM step) for candidate points and to zero for the others.
template<class Exec, class Real>
void finish_step(const Exec& exec, PointContact<Exec>& contact, const mpm::PointsView<Real>& points, double dt);

/// Stores the records of contacts that have a normal under their keys in contact.history, for a checkpoint
/// or another rank; the next search does so itself.
template<class Exec>
void keep_history(const Exec& exec, PointContact<Exec>& contact);

/// Rebuilds from loaded candidates (contact.candidates.body and point) everything that begin_step makes except the
/// private points, which begin_kept_step copies, and the contact records, which the caller writes to
/// contact.tangential.
template<class Exec>
void resume_candidates(const Exec& exec, PointContact<Exec>& contact, const dem::BodiesView& bodies,
                       const PointBodyLaw& law);

/// Gives the bodies of the candidates their rows after others have come; none has gone. `row`: of each body's row
/// before, its present row.
template<class Exec>
void follow_rows(const Exec& exec, PointContact<Exec>& contact, const Array<Exec, std::int32_t>& row,
                 const dem::BodiesView& bodies);

/// Computes the summary of the last substep (dissipated: since the last summary or begin_step); requires candidates.
/// live_named counts the contacts of the first `named` bodies. Returns the address of the result in the backend's
/// memory.
template<class Exec>
const Summary* summarise(const Exec& exec, PointContact<Exec>& contact, std::int64_t named);

} // namespace tread::contact
