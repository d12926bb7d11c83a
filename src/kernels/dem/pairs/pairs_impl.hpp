#pragma once

#include <algorithm>
#include <vector>

#include "kernels/dem/contact/contact_nodes.hpp"
#include "kernels/dem/pairs/allowed_displacement_impl.hpp"
#include "kernels/dem/pairs/pair_search_impl.hpp"
#include "kernels/dem/pairs/select.hpp"
#include "kernels/dem/sleep/sleep.hpp"

// Steps of find_pairs, for both backends; pairs.cpp and pairs.cu provide for_each and instantiate.
namespace tread::dem
{
namespace pair_steps
{

/// Releases memory. Arrays of the search and those of the substeps never exist at the same time: each phase releases
/// its memory when the other begins, and allocates no more than it needs.
template<class... Arrays>
void release_memory(Arrays&... arrays)
{
    (arrays.fit(0), ...);
}

template<class Exec>
void release_memory(SortScratch<Exec>& scratch)
{
    release_memory(scratch.bytes, scratch.keys, scratch.values);
}

template<class Exec>
void release_memory(Answers<Exec>& answers)
{
    release_memory(answers.force, answers.torque, answers.stiffness, answers.energy, answers.friction,
                   answers.restitution, answers.place, answers.second_force, answers.second_torque,
                   answers.second_stiffness);
}

struct MeasureBody
{
    BodiesView          bodies;
    const TemplateView* templates;
    double*             radius;
    double*             node_area;

    TREAD_HD void operator()(std::int64_t b) const
    {
        const TemplateView& shape = templates[bodies.shape[b]];
        const double        scale = bodies.scale[b];
        double              area  = 0;
        for (std::int32_t i = 0; i < shape.node_count; ++i) { area += shape.node_areas[i]; }
        radius[b]    = scale * shape.bounding_radius;
        node_area[b] = shape.node_count > 0 ? scale * scale * area / shape.node_count : 0.0;
    }
};

struct IsLarge
{
    const std::int32_t* marks;

    TREAD_HD bool operator()(std::int64_t b) const { return marks[b] != 0; }
};

struct Stage
{
    BodiesView   bodies;
    ContactBody* body;

    TREAD_HD void operator()(std::int64_t b) const { body[b] = contact_body(bodies, b); }
};

struct MarkPairs
{
    std::int64_t        count;
    const std::int32_t* nodes;
    std::int32_t*       kept; ///< [pairs + 1]

    TREAD_HD void operator()(std::int64_t p) const { kept[p] = p < count && nodes[p] != 0 ? 1 : 0; }
};

struct KeepPairs
{
    const std::uint64_t* key;
    const std::int32_t*  place; ///< [pairs + 1], after the scan
    std::uint64_t*       kept_key;
    std::int32_t*        counted; ///< the place that each kept pair had

    TREAD_HD void operator()(std::int64_t p) const
    {
        if (place[p] == place[p + 1]) { return; }
        kept_key[place[p]] = key[p];
        counted[place[p]]  = static_cast<std::int32_t>(p);
    }
};

/// Takes the number of nodes of each kept pair along to its new place, with a zero for the end of the scan.
struct TakeCounts
{
    std::int64_t        kept;
    const std::int32_t* counted;
    const std::int32_t* nodes; ///< of each pair that was counted; negative: none, but the pair is kept
    std::int32_t*       kept_nodes;

    TREAD_HD void operator()(std::int64_t p) const
    {
        const std::int32_t number = p < kept ? nodes[counted[p]] : 0;
        kept_nodes[p]             = number > 0 ? number : 0;
    }
};

/// Initialises every pair of a new list and its place in the order by second body.
struct Renew
{
    PairsView      pairs;
    std::uint64_t* second_key;
    std::int32_t*  by_second;

    TREAD_HD void operator()(std::int64_t p) const
    {
        pairs.peak[p] = 0;
        second_key[p] = static_cast<std::uint64_t>(second_of(pairs.key[p]));
        by_second[p]  = static_cast<std::int32_t>(p);
    }
};

/// Finds the place of each pair in the order by second body.
struct Place
{
    const std::int32_t* by_second;
    std::int32_t*       place;

    TREAD_HD void operator()(std::int64_t i) const { place[by_second[i]] = static_cast<std::int32_t>(i); }
};

struct ClearAnswers
{
    AnswersView answers;

    TREAD_HD void operator()(std::int64_t p) const { answers.store(p, answers.place[p], no_response()); }
};

/// Records by key.
struct RecordTable
{
    std::int64_t         count;
    const std::uint64_t* key; ///< ascending
    const Patch*         patch;
    const Rolling*       rolling;
};

/// Restores the patch of a pair that was in the previous list, or whose bodies slept.
struct Recall
{
    PairsView   pairs;
    RecordTable last;
    RecordTable asleep;

    TREAD_HD void operator()(std::int64_t p) const
    {
        if (found_in(last, p) || found_in(asleep, p)) { return; }
        pairs.patch[p] = no_patch();
        if (pairs.rolling != nullptr) { pairs.rolling[p] = no_rolling(); }
    }

private:
    TREAD_HD bool found_in(const RecordTable& table, std::int64_t p) const
    {
        const std::int64_t at = find_sorted(table.key, table.count, pairs.key[p]);
        if (at < 0) { return false; }
        pairs.patch[p] = table.patch[at];
        if (pairs.rolling != nullptr) { pairs.rolling[p] = table.rolling[at]; }
        return true;
    }
};

struct WriteRuns
{
    std::int64_t         count;
    const std::uint64_t* key;
    const std::uint64_t* second_key;
    std::int32_t*        first;
    std::int32_t*        second;

    TREAD_HD void operator()(std::int64_t b) const
    {
        first[b]  = static_cast<std::int32_t>(lower_bound(key, count, pair_key(b, 0)));
        second[b] = static_cast<std::int32_t>(lower_bound(second_key, count, static_cast<std::uint64_t>(b)));
    }
};

/// Writes the pair of each node in the list.
struct WritePairsOfNodes
{
    const std::int32_t* first_node; ///< [pairs + 1]
    std::int32_t*       pair_of_node;

    TREAD_HD void operator()(std::int64_t p) const
    {
        for (std::int32_t i = first_node[p]; i < first_node[p + 1]; ++i)
        {
            pair_of_node[i] = static_cast<std::int32_t>(p);
        }
    }
};

/// Rebuilds everything that follows from the keys alone.
template<class Exec>
void order_again(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies)
{
    const std::int64_t count = pairs.key.size();
    release_memory(pairs.of_body.by_second, pairs.peak, pairs.search.second_key);
    pairs.of_body.by_second.resize(count);
    pairs.peak.resize(count);
    pairs.search.second_key.resize(count);
    for_each(exec, "renew pairs", count,
             Renew{pairs.view(), pairs.search.second_key.data(), pairs.of_body.by_second.data()});
    sort_by_key(exec, pairs.search.second_key, pairs.of_body.by_second, pairs.sort, bits_below(most_bodies));

    pairs.of_body.first.resize(bodies.count + 1);
    pairs.of_body.second.resize(bodies.count + 1);
    for_each(exec, "pairs of bodies", bodies.count + 1,
             WriteRuns{count, pairs.key.data(), pairs.search.second_key.data(), pairs.of_body.first.data(),
                       pairs.of_body.second.data()});
}

/// Removes the pairs without any node that may touch, and orders the rest: bounding spheres meet far more often than
/// surfaces.
template<class Exec>
void keep_pairs_with_nodes(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    const std::int64_t count = pairs.key.size();
    pairs.nodes.first.resize(count + 1);
    pairs.search.near.resize(count * near_clusters);
    pairs.search.placed.resize(2 * count);
    count_contact_nodes(exec, pairs, bodies, law);
    pairs.search.found.resize(count + 1);
    for_each(exec, "mark pairs", count + 1, MarkPairs{count, pairs.nodes.first.data(), pairs.search.found.data()});
    const std::int64_t kept = exclusive_scan(exec, pairs.search.found, pairs.sort);
    pairs.search.second_key.resize(kept);
    pairs.search.counted.resize(kept);
    for_each(exec, "keep pairs", count,
             KeepPairs{pairs.key.data(), pairs.search.found.data(), pairs.search.second_key.data(),
                       pairs.search.counted.data()});
    pairs.key.swap(pairs.search.second_key);
    release_memory(pairs.search.second_key, pairs.search.found);
    sort_by_key(exec, pairs.key, pairs.search.counted, pairs.sort, 32 + bits_below(bodies.count));

    pairs.of_body.by_second.resize(kept + 1);
    for_each(exec, "nodes of kept pairs", kept + 1,
             TakeCounts{kept, pairs.search.counted.data(), pairs.nodes.first.data(), pairs.of_body.by_second.data()});
    pairs.nodes.first.swap(pairs.of_body.by_second);
    pairs.nodes.node.resize(exclusive_scan(exec, pairs.nodes.first, pairs.sort));
    list_contact_nodes(exec, pairs, bodies, law);
    release_memory(pairs.of_body.by_second, pairs.search.placed, pairs.search.near, pairs.search.counted);
}

/// Releases the substeps' memory of a list.
template<class Exec>
void end_substeps(Pairs<Exec>& pairs)
{
    release_memory(pairs.answers);
    release_memory(pairs.nodes.node, pairs.nodes.pair, pairs.nodes.found, pairs.nodes.inside, pairs.nodes.first);
}

/// Allocates and initialises the substeps' arrays in addition to the list.
template<class Exec>
void begin_substeps(const Exec& exec, Pairs<Exec>& pairs)
{
    const std::int64_t count = pairs.key.size();
    pairs.answers.resize(count);
    pairs.nodes.pair.resize(pairs.nodes.node.size());
    pairs.nodes.found.resize(pairs.nodes.node.size());
    pairs.nodes.inside.resize(node_words(pairs.nodes.node.size()));
    for_each(exec, "pair places", count, Place{pairs.of_body.by_second.data(), pairs.answers.place.data()});
    for_each(exec, "clear answers", count, ClearAnswers{pairs.answers.view()});
    for_each(exec, "pairs of nodes", count, WritePairsOfNodes{pairs.nodes.first.data(), pairs.nodes.pair.data()});
}

template<class Exec>
void order_pairs(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies)
{
    const std::int64_t count = pairs.key.size();
    pairs.patch.resize(count);
    if (pairs.resists_rolling) { pairs.rolling.resize(count); }
    for_each(exec, "recall pairs", count,
             Recall{pairs.view(),
                    {pairs.last.key.size(), pairs.last.key.data(), pairs.last.patch.data(), pairs.last.rolling.data()},
                    {pairs.sleep.pairs.key.size(), pairs.sleep.pairs.key.data(), pairs.sleep.pairs.patch.data(),
                     pairs.sleep.pairs.rolling.data()}});
    order_again(exec, pairs, bodies);
}

} // namespace pair_steps

template<class Exec>
void classify_bodies(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const TemplateView* templates,
                     double largest)
{
    pairs.measure.resize(bodies.count);
    pairs.sizes.node_area.resize(bodies.count);
    pairs.expected_stiffness.resize(bodies.count);
    pairs.expected_stiffness.fill_zero();
    for_each(exec, "body sizes", bodies.count,
             pair_steps::MeasureBody{bodies, templates, pairs.measure.data(), pairs.sizes.node_area.data()});

    const std::vector<double> radii = pairs.measure.to_host();
    std::vector<std::int32_t> large, marks;
    for (std::size_t b = 0; b < radii.size(); ++b)
    {
        marks.push_back(radii[b] > largest ? 1 : 0);
        if (marks.back() != 0) { large.push_back(static_cast<std::int32_t>(b)); }
    }
    pairs.sizes.large.assign(large);
    pairs.sizes.is_large.assign(marks);
}

template<class Exec>
void list_large_bodies(const Exec& exec, Pairs<Exec>& pairs)
{
    select(exec, "large bodies", pairs.sizes.is_large.size(), pair_steps::IsLarge{pairs.sizes.is_large.data()},
           pairs.search.found, pairs.sort, pairs.sizes.large);
}

template<class Exec>
void stage_bodies(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies)
{
    pairs.body.resize(bodies.count);
    for_each(exec, "stage bodies", bodies.count, pair_steps::Stage{bodies, pairs.body.data()});
}

template<class Exec>
void begin_list(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    pair_steps::end_substeps(pairs);
    pairs.key.swap(pairs.last.key);
    pairs.patch.swap(pairs.last.patch);
    pairs.rolling.swap(pairs.last.rolling);
    pairs.patches.place.swap(pairs.patches.last_place);
    pair_steps::write_speeds(exec, pairs, bodies, law);
}

template<class Exec>
void list_pairs(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    using namespace pair_steps;
    stage_bodies(exec, pairs, bodies);
    release_memory(pairs.of_body.by_second);
    const double cell_size = fill_cells(exec, pairs, bodies, law);
    if (pairs.sleep.wakes) { wake_bodies(exec, pairs, bodies, law, cell_size); }
    search(exec, pairs, bodies, law, cell_size);
    release_memory(pairs.search.extent, pairs.displacement.speed, pairs.displacement.wander,
                   pairs.displacement.per_step, pairs.search.cell_key, pairs.search.cell_body, pairs.search.sphere,
                   pairs.search.found, pairs.search.accepted);
    keep_pairs_with_nodes(exec, pairs, bodies, law);
    order_pairs(exec, pairs, bodies);
    if (pairs.patches.wanted) { split_patches(exec, pairs, bodies, law); }
    list_pairs_of_many_nodes(exec, pairs);
    if (pairs.sleep.wanted) { settle_sleepers(exec, pairs, bodies); }
    release_memory(pairs.last.key, pairs.last.patch, pairs.last.rolling, pairs.search.second_key, pairs.search.found);
    release_memory(pairs.sort);
    begin_substeps(exec, pairs);
}

template<class Exec>
void find_pairs(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt,
                double substeps, double gravity)
{
    begin_list(exec, pairs, bodies, law);
    request_displacement(exec, pairs, bodies, law, dt, gravity, {});
    allow_displacement(exec, pairs, bodies, law, dt, substeps, bodies.count);
    list_pairs(exec, pairs, bodies, law);
}

} // namespace tread::dem
