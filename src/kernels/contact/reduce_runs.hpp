#pragma once

#include "backend/launch.hpp"
#include "kernels/contact/runs.hpp"
#include "kernels/dem/contact/body_field_kern.hpp"

namespace tread::contact
{

/// Calls finish(r, sum over its items i of item(i)) for every run r; sums have a fixed order. Sum needs operator+ and
/// zero().
template<class Sum, class Item, class Finish>
void reduce_runs(const Cpu& cpu, const char* name, const RunsView& runs, Item item, Finish finish)
{
    for_each(cpu, name, runs.count,
             [=](std::int64_t run)
             {
                 Sum sum = Sum::zero();
                 for (std::int64_t i = runs.first[run]; i < runs.first[run + 1]; ++i) { sum = sum + item(i); }
                 finish(run, sum);
             });
}

/// Calls f(r, lanes) for every run r; runs are short.
template<class F>
void for_each_run(const Cpu& cpu, const char* name, const RunsView& runs, F f)
{
    for_each(cpu, name, runs.count, [=](std::int64_t run) { f(run, dem::OneLane{}); });
}

} // namespace tread::contact
