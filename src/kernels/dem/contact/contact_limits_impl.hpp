#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "backend/instantiate.hpp"
#include "backend/reduce.hpp"
#include "kernels/dem/contact/approach_kern.hpp"
#include "kernels/dem/contact/contact_limits.hpp"
#include "kernels/dem/contact/contact_nodes.hpp"

// Steps of contact_limits.hpp, for both backends; contact_limits.cpp and .cu provide for_each.
namespace tread::dem::contact_limits
{

struct ExpectContacts
{
    BodiesView    bodies;
    BodyLaw       law;
    PairsView     pairs;
    const double* node_area;
    const double* entering; ///< N/m, per pair
    double*       expected;
    SharedView    shared;

    template<class Lanes>
    TREAD_HD void operator()(std::int64_t b, const Lanes& lanes) const
    {
        StiffnessShare sums{0, 0, 0};
        for (std::int64_t p = pairs.first[b] + lanes.lane(); p < pairs.first[b + 1]; p += lanes.lanes())
        {
            add(p, sums);
        }
        for (std::int64_t i = pairs.second[b] + lanes.lane(); i < pairs.second[b + 1]; i += lanes.lanes())
        {
            add(pairs.by_second[i], sums);
        }
        sums = {lanes.sum(sums.touches), lanes.largest(sums.first_touch), lanes.sum(sums.approach)};
        if (lanes.lane() != 0) { return; }
        expected[b] = sums.most();
        if (shared.is_shared(b)) { shared.stiffness[shared.place[b]] = sums; }
    }

private:
    TREAD_HD void add(std::int64_t p, StiffnessShare& sums) const
    {
        const double touch = first_touch(p);
        sums.touches += touch;
        sums.first_touch = std::fmax(sums.first_touch, touch);
        sums.approach += pairs.patch[p].stiffness + entering[p];
    }

    TREAD_HD double first_touch(std::int64_t p) const
    {
        if (pairs.patch[p].stiffness > 0) { return 0; }
        const std::int64_t a = first_of(pairs.key[p]), b = second_of(pairs.key[p]);
        const bool         wall = b >= bodies.count;
        const PairLaw      pair = law_of(pairs, law, bodies.count, pairs.key[p]);
        if (exact(a) && (wall || exact(b))) { return touch_of_spheres(pair, approach(a, b)); }
        if (pairs.first_node[p] == pairs.first_node[p + 1]) { return 0; } // an unused row of a pair in several patches
        return touch_of_nodes(pair, wall ? 2.0 * node_area[a] : std::fmax(node_area[a], node_area[b]));
    }

    /// Returns the velocity of the first body towards the second or the wall, m/s.
    TREAD_HD double approach(std::int64_t a, std::int64_t b) const
    {
        if (b >= bodies.count) { return -law.planes[b - bodies.count].normal.dot(bodies.velocity[a]); }
        const Vec3<double> along = (bodies.position[b] - bodies.position[a]).normalized();
        return along.dot(bodies.velocity[a] - bodies.velocity[b]);
    }

    /// Whether body b is an exact sphere.
    TREAD_HD bool exact(std::int64_t b) const { return law.templates[bodies.shape[b]].sphere_radius > 0; }

    /// Returns the stiffness of two nodes of the body with the coarser nodes; `area`: m2, of both.
    TREAD_HD static double touch_of_nodes(const PairLaw& pair, double area)
    {
        return area * traction_at(pair, 0.0).slope;
    }

    /// Returns the stiffness at the maximum overlap of the coming impact.
    TREAD_HD static double touch_of_spheres(const PairLaw& pair, double approach)
    {
        const double overlap = hertz_impact_overlap(pair, std::fmax(approach, 0.0));
        return hertz_stiffness(pair, std::fmax(overlap, pair.linear_overlap));
    }
};

/// Sums the expected stiffness of bodies that several ranks integrate.
struct ExpectTogether
{
    SharedView shared;
    double*    expected;

    TREAD_HD void operator()(std::int64_t i) const { expected[shared.body[i]] = stiffness_of(shared, i).most(); }
};

struct WriteFrequency
{
    BodiesView    bodies;
    const double* expected;
    MassScaling   scaling;
    double*       squared; ///< 1/s2

    TREAD_HD void operator()(std::int64_t b) const
    {
        const bool   moves = bodies.is_owned(b) && !bodies.is_fixed(b) && !bodies.is_asleep(b);
        const double mass  = bodies.mass[b] * (b < scaling.named ? 1.0 : scaling.most);
        squared[b]         = moves ? std::fmax(bodies.stiffness[b], expected[b]) / mass : 0.0;
    }
};

struct WriteOverlap
{
    BodiesView bodies;
    BodyLaw    law;
    PairsView  pairs;
    double*    ratio;

    TREAD_HD void operator()(std::int64_t p) const
    {
        const std::int64_t a = first_of(pairs.key[p]), b = second_of(pairs.key[p]);
        double             radius = equivalent_radius(bodies, law.templates, a);
        if (b < bodies.count) { radius = std::fmin(radius, equivalent_radius(bodies, law.templates, b)); }
        ratio[p] = pairs.peak[p] / radius;
    }
};

/// Computes the expected stiffness with a horizon of twice dt, as for the pairs themselves, because a body may be set
/// in motion within the step. `each_pair`(name, item function) and `each_body` run item functions with a backend's
/// lanes.
template<class Exec, class EachPair, class EachBody>
void expect(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, BodyLaw law, const Vec3<double>& gravity,
            double dt, const SharedView& shared, EachPair each_pair, EachBody each_body)
{
    pairs.measure.resize(pairs.key.size());
    law.rays = nullptr; // rays give no distance outside
    evaluate_nodes(exec, pairs, bodies, law);
    each_pair("anticipated contacts",
              AnticipatePair{bodies, law, pairs.view(), 2 * dt, 0.5 * dt * gravity, pairs.measure.data()});
    pairs.expected_stiffness.resize(bodies.count);
    each_body("expected contacts", ExpectContacts{bodies, law, pairs.view(), pairs.sizes.node_area.data(),
                                                  pairs.measure.data(), pairs.expected_stiffness.data(), shared});
}

} // namespace tread::dem::contact_limits

namespace tread::dem
{

template<class Exec>
void expect_shared_contacts(const Exec& exec, Pairs<Exec>& pairs, const SharedView& shared)
{
    for_each(exec, "expected contacts of shared bodies", shared.count,
             contact_limits::ExpectTogether{shared, pairs.expected_stiffness.data()});
}

template<class Exec>
double smallest_contact_time(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const MassScaling& scaling)
{
    pairs.measure.resize(bodies.count + 1);
    double* largest = pairs.measure.data() + bodies.count;
    for_each(exec, "contact frequencies", bodies.count,
             contact_limits::WriteFrequency{bodies, pairs.expected_stiffness.data(), scaling, pairs.measure.data()});
    largest_of_rows(exec, pairs.measure.data(), bodies.count, 1, largest);
    const double squared = read(exec, largest);
    return squared > 0 ? 1.0 / std::sqrt(squared) : 0.0;
}

template<class Exec>
const double* largest_overlap(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    const std::int64_t count = pairs.key.size();
    pairs.measure.resize(count + 1);
    for_each(exec, "overlap ratios", count,
             contact_limits::WriteOverlap{bodies, law, pairs.view(), pairs.measure.data()});
    largest_of_rows(exec, pairs.measure.data(), count, 1, pairs.measure.data() + count);
    return pairs.measure.data() + count;
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void          expect_shared_contacts(const Exec&, Pairs<Exec>&, const SharedView&);                       \
    template double        smallest_contact_time(const Exec&, Pairs<Exec>&, const BodiesView&, const MassScaling&);    \
    template const double* largest_overlap(const Exec&, Pairs<Exec>&, const BodiesView&, const BodyLaw&)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::dem
