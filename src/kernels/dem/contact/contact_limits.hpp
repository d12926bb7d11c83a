#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "kernels/dem/motion/mass_scaling.hpp"
#include "kernels/dem/motion/shared.hpp"
#include "kernels/dem/pairs/pairs.hpp"

// Time step limits of the contacts and the guards of the penalty law.
namespace tread::dem
{

/// Computes pairs.expected_stiffness of every body that substeps compute, N/m: the largest of three figures of its
/// listed pairs. The stiffest first touch (two nodes in the linear part of the traction) of a separated pair; half of
/// the sum of all first touches; the sum over the nodes in contact and those that enter when they move by twice the
/// displacement that velocity and gravity (m/s2) give in dt (s). Call after find_pairs. For bodies that several ranks
/// integrate it uses this rank's pairs and writes their shares to shared.stiffness.
template<class Exec>
void expect_contacts(const Exec&, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law,
                     const Vec3<double>& gravity, double dt, const SharedView& shared = {});

/// Expected stiffness of shared bodies from the pairs of all ranks; call after the exchange of shares.
template<class Exec>
void expect_shared_contacts(const Exec& exec, Pairs<Exec>& pairs, const SharedView& shared);

/// Returns the minimum of sqrt(m/K) (s) over the bodies that can move and do not sleep, where K is the larger of the
/// body's present stiffness and of the expected one (expect_contacts), and a rock's m is as large as it may be scaled;
/// 0 without any contact, present or expected. Substeps of 0.2 times that conserve energy (docs/theory.md#time-step).
template<class Exec>
double smallest_contact_time(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies,
                             const MassScaling& scaling = {});

/// Returns the body with this minimum; call after smallest_contact_time.
template<class Exec>
std::int64_t stiffest_body(const Pairs<Exec>& pairs, std::int64_t bodies)
{
    const std::vector<double> squared = pairs.measure.to_host();
    return std::max_element(squared.begin(), squared.begin() + bodies) - squared.begin();
}

/// Computes the maximum over all pairs of the overlap divided by the smaller equivalent radius of the pair, since the
/// pairs were listed; 0 if nothing touched. Returns the address of the result in the backend's memory, valid until
/// pairs.measure is used again. Warn above 0.1, stop above 0.5.
template<class Exec>
const double* largest_overlap(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law);

/// Returns the pair with this maximum; call after largest_overlap.
template<class Exec>
std::uint64_t deepest_pair(Pairs<Exec>& pairs, double largest)
{
    const std::vector<double> ratios = pairs.measure.to_host();
    const auto                at     = std::find(ratios.begin(), ratios.end(), largest) - ratios.begin();
    return read(pairs.key.exec(), pairs.key.data() + at);
}

} // namespace tread::dem
