#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "kernels/dem/motion/shared.hpp"
#include "kernels/dem/pairs/pairs.hpp"

// What the contacts ask of the time step, and the guards of the penalty law.
namespace tread::dem
{

/// pairs.expected_stiffness of every body, N/m: the larger of two sums over its listed pairs. One is of first touches
/// (two nodes in the linear part of the traction) of those that are apart; the other of what touches and of the nodes
/// that come inside when they move by twice what velocity and gravity (m/s2) make of them in dt (s). After find_pairs.
/// Of bodies that several ranks move: of this rank's pairs, and their shares in shared.stiffness.
void expect_contacts(const Cpu&, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law,
                     const Vec3<double>& gravity, double dt, const SharedView& shared = {});
void expect_contacts(const Gpu&, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law,
                     const Vec3<double>& gravity, double dt, const SharedView& shared = {});

/// Those bodies', of all ranks' pairs, when their shares are there.
void expect_shared_contacts(const Cpu&, Pairs<Cpu>& pairs, const SharedView& shared);
void expect_shared_contacts(const Gpu&, Pairs<Gpu>& pairs, const SharedView& shared);

/// The least sqrt(m/K) (s) over the bodies that can move, K = the larger of the body's live stiffness and of what
/// expect_contacts found; 0 without any contact, live or expected. A substep of 0.2 times that keeps energy
/// (docs/theory.md#time-step).
double smallest_contact_time(const Cpu&, Pairs<Cpu>& pairs, const BodiesView& bodies);
double smallest_contact_time(const Gpu&, Pairs<Gpu>& pairs, const BodiesView& bodies);

/// Which body has it, after smallest_contact_time has found it.
template<class Exec>
std::int64_t stiffest_body(const Pairs<Exec>& pairs, std::int64_t bodies)
{
    const std::vector<double> squared = pairs.measure.to_host();
    return std::max_element(squared.begin(), squared.begin() + bodies) - squared.begin();
}

/// The largest overlap over the smaller equivalent radius of the pair, of any pair since it was listed; 0 if nothing
/// touched; returns where the backend will have it, until pairs.measure is used again. Warn above 0.1, stop above 0.5.
const double* largest_overlap(const Cpu&, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law);
const double* largest_overlap(const Gpu&, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law);

/// Which pair that is, after largest_overlap has found it.
template<class Exec>
std::uint64_t deepest_pair(Pairs<Exec>& pairs, double largest)
{
    const std::vector<double> ratios = pairs.measure.to_host();
    const auto                at     = std::find(ratios.begin(), ratios.end(), largest) - ratios.begin();
    return read(pairs.key.exec(), pairs.key.data() + at);
}

} // namespace tread::dem
