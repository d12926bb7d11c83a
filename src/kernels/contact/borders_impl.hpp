#pragma once

#include "backend/instantiate.hpp"
#include "backend/reduce.hpp"
#include "kernels/contact/borders.hpp"
#include "kernels/dem/pairs/select.hpp"

// Steps of borders.hpp, for both backends; borders.cpp and borders.cu provide for_each.
namespace tread::contact::border_steps
{

// The analyzer of clang takes an array whose size it does not know to have no memory, and objects to a copy into it.
// NOLINTBEGIN(clang-analyzer-core.NonNullParamChecker,clang-analyzer-core.CallAndMessage)
template<class T>
struct SetAt
{
    const std::int32_t* at;
    const T*            value;
    T*                  values;

    TREAD_HD void operator()(std::int64_t i) const { values[at[i]] = value[i]; }
};

template<class T>
struct Fill
{
    T  value;
    T* values;

    TREAD_HD void operator()(std::int64_t i) const { values[i] = value; }
};
// NOLINTEND(clang-analyzer-core.NonNullParamChecker,clang-analyzer-core.CallAndMessage)

struct WritePlace
{
    const std::int32_t* body;
    std::int32_t*       place;

    TREAD_HD void operator()(std::int64_t i) const { place[body[i]] = static_cast<std::int32_t>(i); }
};

/// Own reaches of a rank's bodies; those of others are 0.
struct OwnReach
{
    dem::BodiesView     bodies;
    const double*       bounding_radius;
    dem::AllowedMotion  allowed;
    const std::int32_t* is_large;

    TREAD_HD double of(std::int64_t b) const { return bounding_radius[b] + allowed.way_of(b); }
};

struct WriteReaches
{
    OwnReach own;
    double*  rows; ///< [bodies x 2]

    TREAD_HD void operator()(std::int64_t b) const
    {
        const double reach = own.bodies.is_owned(b) ? own.of(b) : 0.0;
        rows[2 * b]        = reach;
        rows[2 * b + 1]    = own.is_large[b] == 0 ? reach : 0.0;
    }
};

struct Ball
{
    OwnReach    own;
    BorderReach reach;

    TREAD_HD BorderBody operator()(std::int64_t b) const
    {
        const double met = own.is_large[b] != 0 ? reach.met_by_large : reach.met_by_small;
        return {own.bodies.position[b], own.bounding_radius[b], {own.of(b) + met, own.of(b) + reach.sand}};
    }
};

struct IsAtBorder
{
    Ball             ball;
    const Clearance* clear;

    TREAD_HD bool operator()(std::int64_t b) const
    {
        if (!ball.own.bodies.is_owned(b)) { return false; }
        const BorderBody body  = ball(b);
        const double     moved = (body.position - clear[b].position).norm();
        return !(moved + body.reach.bodies < clear[b].within.bodies && moved + body.reach.sand < clear[b].within.sand);
    }
};

struct WriteBalls
{
    Ball                ball;
    const std::int32_t* body;
    BorderBody*         rows;

    TREAD_HD void operator()(std::int64_t i) const { rows[i] = ball(body[i]); }
};

template<class Exec>
OwnReach own_reach(const double* bounding_radius, const dem::Pairs<Exec>& pairs, const dem::BodiesView& bodies)
{
    return {bodies, bounding_radius, pairs.displacement.view(), pairs.sizes.is_large.data()};
}

} // namespace tread::contact::border_steps

namespace tread::contact
{

template<class Exec>
void begin_borders(const Exec& exec, Borders<Exec>& borders, std::int64_t bodies)
{
    borders.clear.resize(bodies);
    forget_clearances(exec, borders);
}

template<class Exec>
void forget_clearances(const Exec& exec, Borders<Exec>& borders)
{
    for_each(exec, "forget clearances", borders.clear.size(), border_steps::Fill<Clearance>{{}, borders.clear.data()});
}

template<class Exec>
void keep_clearances(const Exec& exec, Borders<Exec>& borders, const std::vector<std::int32_t>& body,
                     const std::vector<Clearance>& clear)
{
    if (body.empty()) { return; }
    Array<Exec, std::int32_t> at(exec, "bodies to set");
    Array<Exec, Clearance>    value(exec, "balls to set");
    at.assign(body);
    value.assign(clear);
    for_each(exec, "keep clearances", at.size(),
             border_steps::SetAt<Clearance>{at.data(), value.data(), borders.clear.data()});
}

template<class Exec>
std::array<double, 2> largest_reaches(const Exec& exec, const double* bounding_radius, dem::Pairs<Exec>& pairs,
                                      const dem::BodiesView& bodies)
{
    pairs.measure.resize(2 * bodies.count + 2);
    double* rows = pairs.measure.data();
    for_each(exec, "reaches of bodies", bodies.count,
             border_steps::WriteReaches{border_steps::own_reach(bounding_radius, pairs, bodies), rows});
    largest_of_rows(exec, rows, bodies.count, 2, rows + 2 * bodies.count);
    return read(exec, reinterpret_cast<const std::array<double, 2>*>(rows + 2 * bodies.count));
}

template<class Exec>
void list_borders(const Exec& exec, Borders<Exec>& borders, const double* bounding_radius, dem::Pairs<Exec>& pairs,
                  const dem::BodiesView& bodies, const BorderReach& reach)
{
    const border_steps::Ball ball{border_steps::own_reach(bounding_radius, pairs, bodies), reach};
    dem::select(exec, "bodies at borders", bodies.count, border_steps::IsAtBorder{ball, borders.clear.data()},
                pairs.search.found, pairs.sort, borders.body);
    borders.ball.fit(borders.body.size());
    for_each(exec, "balls of bodies at borders", borders.body.size(),
             border_steps::WriteBalls{ball, borders.body.data(), borders.ball.data()});
}

template<class Exec>
void write_places(const Exec& exec, const Array<Exec, std::int32_t>& body, Array<Exec, std::int32_t>& place)
{
    for_each(exec, "write places", body.size(), border_steps::WritePlace{body.data(), place.data()});
}

template<class Exec>
void forget_places(const Exec& exec, Array<Exec, std::int32_t>& place)
{
    for_each(exec, "forget places", place.size(), border_steps::Fill<std::int32_t>{-1, place.data()});
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void                  begin_borders(const Exec&, Borders<Exec>&, std::int64_t);                           \
    template void                  forget_clearances(const Exec&, Borders<Exec>&);                                     \
    template void                  keep_clearances(const Exec&, Borders<Exec>&, const std::vector<std::int32_t>&,      \
                                                   const std::vector<Clearance>&);                                     \
    template std::array<double, 2> largest_reaches(const Exec&, const double*, dem::Pairs<Exec>&,                      \
                                                   const dem::BodiesView&);                                            \
    template void list_borders(const Exec&, Borders<Exec>&, const double*, dem::Pairs<Exec>&, const dem::BodiesView&,  \
                               const BorderReach&);                                                                    \
    template void write_places(const Exec&, const Array<Exec, std::int32_t>&, Array<Exec, std::int32_t>&);             \
    template void forget_places(const Exec&, Array<Exec, std::int32_t>&)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::contact
