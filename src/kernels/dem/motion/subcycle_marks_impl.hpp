#pragma once

#include "backend/atomic.hpp"
#include "backend/instantiate.hpp"
#include "kernels/dem/motion/subcycle_marks.hpp"

// Steps of subcycle_marks.hpp, for both backends; subcycle_marks.cpp and .cu provide for_each.
namespace tread::dem::subcycle_steps
{

struct MarkPair
{
    BodiesView    bodies;
    PairsView     pairs;
    const double* expected; ///< N/m, stiffness of each body
    double        shortest; ///< s
    std::int32_t* of_pair;
    std::int32_t* of_body; ///< 0 before

    TREAD_HD void operator()(std::int64_t p) const
    {
        const std::int64_t a = first_of(pairs.key[p]), b = second_of(pairs.key[p]);
        const bool         wall  = b >= bodies.count;
        const bool         stiff = is_stiff(a) || (!wall && is_stiff(b));
        of_pair[p]               = stiff ? 1 : 0;
        if (!stiff) { return; }
        store_together(of_body + a, 1);
        if (!wall) { store_together(of_body + b, 1); }
    }

private:
    TREAD_HD bool is_stiff(std::int64_t b) const
    {
        if (bodies.is_fixed(b) || bodies.is_asleep(b)) { return false; }
        return std::fmax(bodies.stiffness[b], expected[b]) * shortest * shortest > bodies.mass[b];
    }
};

struct ShareMark
{
    SharedView          shared;
    const std::int32_t* of_body;

    TREAD_HD void operator()(std::int64_t i) const { shared.mark[i] = of_body[shared.body[i]]; }
};

struct TakeMark
{
    SharedView    shared;
    std::int32_t* of_body;

    TREAD_HD void operator()(std::int64_t i) const { of_body[shared.body[i]] = mark_of_all(shared, i); }
};

} // namespace tread::dem::subcycle_steps

namespace tread::dem
{

template<class Exec>
void mark_stiff(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, double shortest,
                const SharedView& shared)
{
    using namespace subcycle_steps;
    pairs.stiff.pair.resize(pairs.key.size());
    pairs.stiff.body.resize(bodies.count);
    pairs.stiff.start.resize(bodies.count);
    pairs.stiff.body.fill_zero();
    for_each(exec, "stiff pairs", pairs.key.size(),
             MarkPair{bodies, pairs.view(), pairs.expected_stiffness.data(), shortest, pairs.stiff.pair.data(),
                      pairs.stiff.body.data()});
    for_each(exec, "share stiff bodies", shared.count, ShareMark{shared, pairs.stiff.body.data()});
}

template<class Exec>
void mark_shared_stiff(const Exec& exec, Pairs<Exec>& pairs, const SharedView& shared)
{
    for_each(exec, "shared stiff bodies", shared.count, subcycle_steps::TakeMark{shared, pairs.stiff.body.data()});
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void mark_stiff(const Exec&, Pairs<Exec>&, const BodiesView&, double, const SharedView&);                 \
    template void mark_shared_stiff(const Exec&, Pairs<Exec>&, const SharedView&)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::dem
