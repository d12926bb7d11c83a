#pragma once

#include "kernels/dem/pairs/pairs_impl.hpp"
#include "kernels/dem/pairs/relist.hpp"
#include "kernels/dem/pairs/select.hpp"

// Steps of relist.hpp, for both backends; pairs.cpp and pairs.cu provide for_each and instantiate.
namespace tread::dem
{
namespace pair_steps
{

/// Share of its allowed displacement from which a body has strayed. A body at rest uses half of it (rest_reserve);
/// those that are far along are relisted with those that have no more, or each of them would end a list soon.
inline constexpr double strayed_from = 0.75;

struct MarkStrayedBody
{
    BodiesView    bodies;
    const double* share;
    std::int32_t* mark;

    TREAD_HD void operator()(std::int64_t b) const
    {
        const bool near = share[b] <= strayed_from;
        mark[b]         = !near ? relist_strayed : bodies.is_asleep(b) ? relist_slept : relist_none;
    }
};

struct HasStrayed
{
    const std::int32_t* mark;

    TREAD_HD bool operator()(std::int64_t b) const { return mark[b] == relist_strayed; }
};

struct IsRelisted
{
    BodiesView          bodies;
    const std::int32_t* mark;

    TREAD_HD bool operator()(std::int64_t b) const { return is_relisted(bodies, mark, b); }
};

/// Whether row p of the last list is the first of a pair that stays: neither body is relisted, and one is awake.
struct StaysListed
{
    BodiesView           bodies;
    const std::uint64_t* key;
    const std::int32_t*  mark;

    TREAD_HD bool operator()(std::int64_t p) const
    {
        const std::int64_t a = first_of(key[p]), b = second_of(key[p]);
        if (whole_pair(key[p]) != key[p] || is_relisted(bodies, mark, a)) { return false; }
        if (b >= bodies.count) { return !bodies.is_asleep(a); }
        return !is_relisted(bodies, mark, b) && !(bodies.is_asleep(a) && bodies.is_asleep(b));
    }
};

/// Pairs of the last list that stay, or those found anew.
struct ListedPairs
{
    std::int64_t         count;
    const std::uint64_t* key;        ///< ascending
    const std::int32_t*  first_node; ///< [count + 1]
};

/// Puts the pairs that stay and the new ones into one ascending list. Item i: the i-th that stays, then the new ones.
struct MergePairs
{
    ListedPairs         old, found;
    const std::int32_t* kept; ///< rows of the old list, ascending
    std::int64_t        kept_count;
    std::uint64_t*      key;
    std::int32_t*       nodes; ///< [all + 1], number of nodes of each
    std::int32_t*       source;

    TREAD_HD void operator()(std::int64_t i) const
    {
        const std::int64_t all = kept_count + found.count;
        if (i == all) { nodes[all] = 0; }
        else if (i < kept_count) { keep(i); }
        else { add(i - kept_count); }
    }

private:
    TREAD_HD void keep(std::int64_t i) const
    {
        const std::int64_t p     = kept[i];
        const std::int64_t place = i + lower_bound(found.key, found.count, old.key[p]);
        std::int64_t       end   = p + 1; // a pair in several patches is one again
        while (end < old.count && same_pair(old.key[end], old.key[p])) { ++end; }
        write(place, old.key[p], old.first_node[end] - old.first_node[p], old.first_node[p]);
    }

    TREAD_HD void add(std::int64_t n) const
    {
        const std::int64_t place = n + kept_before(found.key[n]);
        write(place, found.key[n], found.first_node[n + 1] - found.first_node[n], ~found.first_node[n]);
    }

    TREAD_HD void write(std::int64_t place, std::uint64_t pair, std::int32_t number, std::int32_t from) const
    {
        key[place]    = pair;
        nodes[place]  = number;
        source[place] = from;
    }

    /// Number of pairs that stay with keys below `pair`.
    TREAD_HD std::int64_t kept_before(std::uint64_t pair) const
    {
        const auto row = static_cast<std::int32_t>(lower_bound(old.key, old.count, pair));
        return lower_bound(kept, kept_count, row);
    }
};

struct MergeNodes
{
    const std::int32_t* source;
    const std::int32_t* old_node;
    const std::int32_t* new_node;
    const std::int32_t* first; ///< [pairs + 1]
    std::int32_t*       node;

    TREAD_HD void operator()(std::int64_t p) const
    {
        const std::int32_t* from = source[p] < 0 ? new_node + ~source[p] : old_node + source[p];
        for (std::int32_t i = first[p]; i < first[p + 1]; ++i) { node[i] = from[i - first[p]]; }
    }
};

/// Adds to the pairs found anew those of the last list that stay.
template<class Exec>
void merge_lists(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies)
{
    Relisting<Exec>& relisting = pairs.relisting;
    select(exec, "kept pairs", pairs.last.key.size(), StaysListed{bodies, pairs.last.key.data(), relisting.mark.data()},
           pairs.search.found, pairs.sort, relisting.kept);
    const std::int64_t kept = relisting.kept.size(), all = kept + pairs.key.size();
    relisting.key.resize(all);
    relisting.first.resize(all + 1);
    relisting.source.resize(all);
    for_each(exec, "merge pairs", all + 1,
             MergePairs{{pairs.last.key.size(), pairs.last.key.data(), relisting.old_first.data()},
                        {pairs.key.size(), pairs.key.data(), pairs.nodes.first.data()},
                        relisting.kept.data(),
                        kept,
                        relisting.key.data(),
                        relisting.first.data(),
                        relisting.source.data()});
    relisting.node.resize(exclusive_scan(exec, relisting.first, pairs.sort));
    for_each(exec, "merge nodes", all,
             MergeNodes{relisting.source.data(), relisting.old_node.data(), pairs.nodes.node.data(),
                        relisting.first.data(), relisting.node.data()});
    pairs.key.swap(relisting.key);
    pairs.nodes.first.swap(relisting.first);
    pairs.nodes.node.swap(relisting.node);
    release_memory(relisting.key, relisting.first, relisting.node, relisting.source, relisting.kept,
                   relisting.old_first, relisting.old_node, relisting.body, relisting.mark, pairs.search.found);
}

} // namespace pair_steps

template<class Exec>
std::int64_t mark_strayed(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const double* share)
{
    Relisting<Exec>& relisting = pairs.relisting;
    relisting.mark.resize(bodies.count);
    for_each(exec, "mark strayed bodies", bodies.count,
             pair_steps::MarkStrayedBody{bodies, share, relisting.mark.data()});
    select(exec, "strayed bodies", bodies.count, pair_steps::HasStrayed{relisting.mark.data()}, pairs.search.found,
           pairs.sort, relisting.body);
    return relisting.body.size();
}

template<class Exec>
void relist_pairs(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodiesView& at_search,
                  const BodyLaw& law)
{
    using namespace pair_steps;
    Relisting<Exec>& relisting = pairs.relisting;
    relisting.old_first.swap(pairs.nodes.first);
    relisting.old_node.swap(pairs.nodes.node);
    stage_bodies(exec, pairs, bodies);
    release_memory(pairs.of_body.by_second);
    PairSearch search = make_search(pairs, at_search, law, fill_cells(exec, pairs, at_search));
    if (pairs.sleep.wakes) { wake_bodies(exec, pairs, bodies, search); }
    select(exec, "relisted bodies", bodies.count, IsRelisted{bodies, relisting.mark.data()}, pairs.search.found,
           pairs.sort, relisting.body);
    search.mark           = relisting.mark.data();
    search.relisted       = relisting.body.data();
    search.relisted_count = relisting.body.size();
    find_keys(exec, pairs, search);
    end_search(pairs);
    keep_pairs_with_nodes(exec, pairs, at_search, law);
    merge_lists(exec, pairs, bodies);
    complete_list(exec, pairs, bodies, law);
}

} // namespace tread::dem
