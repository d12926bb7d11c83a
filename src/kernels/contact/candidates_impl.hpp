#pragma once

#include "kernels/contact/candidates_kern.hpp"

// Steps of find_candidates, for both backends; candidates.cpp and candidates.cu provide for_each and instantiate. Four
// lists, each derived from the previous one by counting, scanning and filling: (body, page of its box), (body, page
// with points), (body, cell of such a page and of its box), (body, point).
namespace tread::contact
{
namespace candidate_steps
{

struct CountLookups
{
    dem::BodiesView          bodies;
    const dem::TemplateView* templates;
    mpm::PagesView           pages;
    SearchReach              reach;
    std::int32_t*            count; ///< [bodies + 1]

    TREAD_HD void operator()(std::int64_t b) const
    {
        count[b] = 0;
        if (b == bodies.count || !bodies.is_here(b)) { return; }
        count[b] = static_cast<std::int32_t>(lookups(search_body(bodies, templates, b, reach), pages, reach));
    }
};

struct Lookup
{
    std::int64_t body;
    std::int64_t page; ///< -1 = no points
};

struct PageLookups
{
    dem::BodiesView          bodies;
    const dem::TemplateView* templates;
    mpm::PagesView           pages;
    SearchReach              reach;
    const std::int32_t*      first; ///< first lookup of each body

    TREAD_HD Lookup operator()(std::int64_t i) const
    {
        const std::int64_t b = owner_of(first, bodies.count, i);
        return {b, contact::lookup_page(search_body(bodies, templates, b, reach), pages, reach, i - first[b])};
    }
};

struct MarkPages
{
    PageLookups   page_lookups;
    std::int64_t  lookups;
    std::int32_t* marks; ///< [lookups + 1]

    TREAD_HD void operator()(std::int64_t i) const { marks[i] = i < lookups && page_lookups(i).page >= 0; }
};

struct WritePairs
{
    PageLookups         page_lookups;
    const std::int32_t* place; ///< [lookups + 1], after the scan
    std::int32_t*       pair_body;
    std::int32_t*       pair_page;

    TREAD_HD void operator()(std::int64_t i) const
    {
        if (place[i + 1] == place[i]) { return; }
        const Lookup found  = page_lookups(i);
        pair_body[place[i]] = static_cast<std::int32_t>(found.body);
        pair_page[place[i]] = static_cast<std::int32_t>(found.page);
    }
};

struct CountCells
{
    const std::int32_t*      pair_body;
    const std::int32_t*      pair_page;
    std::int64_t             pairs;
    dem::BodiesView          bodies;
    const dem::TemplateView* templates;
    mpm::PagesView           pages;
    SearchReach              reach;
    std::int32_t*            pair_box; ///< PageCells::packed of each pair
    std::int32_t*            count;    ///< [pairs + 1]

    TREAD_HD void operator()(std::int64_t i) const
    {
        count[i] = 0;
        if (i == pairs) { return; }
        const PageCells box = cell_box(search_body(bodies, templates, pair_body[i], reach), pages, pair_page[i], reach);
        pair_box[i]         = box.packed();
        count[i]            = box.cells();
    }
};

/// Calls visit(body, point) for every candidate among the points of one cell; item i = (pair, cell of its box).
template<class Real>
struct Probe
{
    const std::int32_t*      pair_body;
    const std::int32_t*      pair_page;
    const std::int32_t*      pair_box;
    const std::int32_t*      first_cell; ///< [pairs + 1], first item of each pair
    std::int64_t             pairs;
    mpm::PagesView           pages;
    dem::BodiesView          bodies;
    const dem::TemplateView* templates;
    SearchReach              reach;
    mpm::PointsView<Real>    points;
    dem::PairTable           materials;
    RadiusRule               radius;

    template<class Visit>
    TREAD_HD void operator()(std::int64_t i, Visit visit) const
    {
        const std::int64_t  pair = owner_of(first_cell, pairs, i), page = pair_page[pair];
        const std::int32_t  cell  = static_cast<std::int32_t>(i) - first_cell[pair];
        const int           place = PageCells::unpacked(pair_box[pair]).place(cell);
        const std::int32_t* range = pages.cell_first_point + page * mpm::page_cells + place;
        if (range[0] == range[1]) { return; }
        const SearchBody body = search_body(bodies, templates, pair_body[pair], reach);
        if (!cell_may_touch(body, pages, page, place, reach)) { return; }
        for (std::int32_t at = range[0]; at < range[1]; ++at)
        {
            const std::int32_t p   = pages.point_at[at];
            const double       own = point_radius(static_cast<double>(points.volume[p]), radius);
            if (may_touch(body, points.position.get(p), own) && touch(p, pair_body[pair]))
            {
                visit(pair_body[pair], p);
            }
        }
    }

private:
    TREAD_HD bool touch(std::int32_t point, std::int32_t b) const
    {
        return materials(points.material[point], bodies.material[b]).touch;
    }
};

template<class Real>
struct CountCandidates
{
    Probe<Real>   probe;
    std::int64_t  count;
    std::int32_t* found; ///< [count + 1]

    TREAD_HD void operator()(std::int64_t i) const
    {
        found[i] = 0;
        if (i < count)
        {
            probe(i, [this, i](std::int32_t, std::int32_t) { ++found[i]; });
        }
    }
};

template<class Real>
struct WriteCandidates
{
    Probe<Real>         probe;
    const std::int32_t* first; ///< [count + 1], after the scan
    std::int32_t*       body;
    std::int32_t*       point;

    TREAD_HD void operator()(std::int64_t i) const
    {
        std::int32_t place = first[i];
        if (place == first[i + 1]) { return; }
        probe(i,
              [&](std::int32_t b, std::int32_t p)
              {
                  body[place]    = b;
                  point[place++] = p;
              });
    }
};

struct SortKeys
{
    const std::int32_t* point;
    std::uint64_t*      keys;
    std::int32_t*       order;

    TREAD_HD void operator()(std::int64_t i) const
    {
        keys[i]  = static_cast<std::uint64_t>(point[i]);
        order[i] = static_cast<std::int32_t>(i);
    }
};

struct Narrow
{
    const std::uint64_t* keys;
    std::int32_t*        points;

    TREAD_HD void operator()(std::int64_t i) const { points[i] = static_cast<std::int32_t>(keys[i]); }
};

struct WriteTouched
{
    const std::int32_t* in_order;
    const std::int32_t* heads; ///< after find_runs
    std::int32_t*       touched;

    TREAD_HD void operator()(std::int64_t i) const { touched[in_order[i]] = heads[i + 1] - 1; }
};

} // namespace candidate_steps

template<class Exec>
void clear(Candidates<Exec>& candidates)
{
    const auto empty = [](auto&... arrays) { (arrays.resize(0), ...); };
    empty(candidates.body, candidates.point, candidates.touched, candidates.in_order, candidates.by_body.key,
          candidates.by_body.first, candidates.by_point.key, candidates.by_point.first,
          candidates.body_parts.of_items.key, candidates.body_parts.of_items.first, candidates.body_parts.first_of_run);
}

/// Finds the (body, page with points) pairs; returns their number.
template<class Exec>
std::int64_t find_page_pairs(const Exec& exec, Candidates<Exec>& c, const mpm::PagesView& pages,
                             const dem::BodiesView& bodies, const dem::TemplateView* templates,
                             const SearchReach& reach)
{
    using namespace candidate_steps;
    c.box_first.resize(bodies.count + 1);
    for_each(exec, "count contact pages", bodies.count + 1,
             CountLookups{bodies, templates, pages, reach, c.box_first.data()});
    const std::int64_t lookups = exclusive_scan(exec, c.box_first, c.sort);
    if (lookups == 0) { return 0; }

    const PageLookups page_lookups{bodies, templates, pages, reach, c.box_first.data()};
    c.pair_first.resize(lookups + 1);
    for_each(exec, "find contact pages", lookups + 1, MarkPages{page_lookups, lookups, c.pair_first.data()});
    const std::int64_t pairs = exclusive_scan(exec, c.pair_first, c.sort);
    if (pairs == 0) { return 0; }

    c.pair_body.resize(pairs);
    c.pair_page.resize(pairs);
    for_each(exec, "write contact pages", lookups,
             WritePairs{page_lookups, c.pair_first.data(), c.pair_body.data(), c.pair_page.data()});
    return pairs;
}

/// Finds the cells of each pair that its body's box overlaps; returns their number.
template<class Exec>
std::int64_t find_cells(const Exec& exec, Candidates<Exec>& c, std::int64_t pairs, const mpm::PagesView& pages,
                        const dem::BodiesView& bodies, const dem::TemplateView* templates, const SearchReach& reach)
{
    c.pair_box.resize(pairs);
    c.first_cell.resize(pairs + 1);
    for_each(exec, "count contact cells", pairs + 1,
             candidate_steps::CountCells{c.pair_body.data(), c.pair_page.data(), pairs, bodies, templates, pages, reach,
                                         c.pair_box.data(), c.first_cell.data()});
    return exclusive_scan(exec, c.first_cell, c.sort);
}

template<class Exec>
void order_by_point(const Exec& exec, Candidates<Exec>& c)
{
    using namespace candidate_steps;
    const std::int64_t count = c.body.size();
    c.sort_keys.resize(count);
    c.in_order.resize(count);
    c.sorted_points.resize(count);
    c.touched.resize(count);
    find_runs(exec, c.body, c.marks, c.by_body, c.sort);
    split_runs(exec, c.by_body.view(), c.body_parts, c.sort);
    for_each(exec, "candidate sort keys", count, SortKeys{c.point.data(), c.sort_keys.data(), c.in_order.data()});
    constexpr int point_bits = 31; // of a point index
    sort_by_key(exec, c.sort_keys, c.in_order, c.sort, point_bits);
    for_each(exec, "candidate sorted points", count, Narrow{c.sort_keys.data(), c.sorted_points.data()});
    find_runs(exec, c.sorted_points, c.marks, c.by_point, c.sort);
    for_each(exec, "touched points", count, WriteTouched{c.in_order.data(), c.marks.data(), c.touched.data()});
}

template<class Exec, class Real>
void find_candidates(const Exec& exec, Candidates<Exec>& c, const mpm::PointsView<Real>& points,
                     const mpm::PagesView& pages, const dem::BodiesView& bodies, const dem::TemplateView* templates,
                     const dem::PairTable& materials, RadiusRule radius, const SearchReach& reach)
{
    using namespace candidate_steps;
    clear(c);
    if (bodies.count == 0 || points.count == 0) { return; }
    const std::int64_t pairs = find_page_pairs(exec, c, pages, bodies, templates, reach);
    if (pairs == 0) { return; }

    const std::int64_t cells = find_cells(exec, c, pairs, pages, bodies, templates, reach);
    const Probe<Real>  probe{c.pair_body.data(),
                            c.pair_page.data(),
                            c.pair_box.data(),
                            c.first_cell.data(),
                            pairs,
                            pages,
                            bodies,
                            templates,
                            reach,
                            points,
                            materials,
                            radius};
    c.cell_first.resize(cells + 1);
    for_each(exec, "count candidates", cells + 1, CountCandidates<Real>{probe, cells, c.cell_first.data()});
    const std::int64_t found = exclusive_scan(exec, c.cell_first, c.sort);
    if (found == 0) { return; }

    c.body.resize(found);
    c.point.resize(found);
    for_each(exec, "write candidates", cells,
             WriteCandidates<Real>{probe, c.cell_first.data(), c.body.data(), c.point.data()});
    order_by_point(exec, c);
}

} // namespace tread::contact
