#pragma once

#include "kernels/dem/contact/patch_rows_kern.hpp"
#include "kernels/dem/contact/patches.hpp"
#include "kernels/dem/pairs/pairs_impl.hpp"
#include "kernels/dem/pairs/select.hpp"

// Steps of patches.hpp for lanes that share a pair; patches.cpp and patches.cu provide for_each and the lanes.
namespace tread::dem::patches
{

/// Rows of pairs with their records, ascending by key.
struct RowTable
{
    std::int64_t         count;
    const std::uint64_t* key;
    Patch*               patch;
    Rolling*             rolling; ///< null without rolling friction, as in the list
    Vec3<double>*        place;

    TREAD_HD RowRecords of(std::uint64_t pair) const
    {
        const std::int64_t start = lower_bound(key, count, pair);
        int                rows  = 0;
        while (start + rows < count && same_pair(key[start + rows], pair)) { ++rows; }
        return {rows, patch + start, rolling == nullptr ? nullptr : rolling + start,
                place == nullptr ? nullptr : place + start};
    }
};

/// Rows of the previous list, and of pairs whose bodies slept: a pair that stays keeps as many rows, because it may
/// need them again.
struct LastRows
{
    RowTable listed;
    RowTable asleep;

    TREAD_HD RowRecords of(std::uint64_t pair) const
    {
        const RowRecords found = listed.of(pair);
        return found.count > 0 ? found : asleep.of(pair);
    }
};

/// Counts the rows of each pair of a list without patches, after its nodes were grouped.
struct CountRows
{
    GroupNodes    group;
    LastRows      last;
    std::int32_t* rows; ///< [pairs + 1]

    template<class Lanes>
    TREAD_HD void operator()(std::int64_t p, const Lanes& lanes) const
    {
        const PairsView& pairs = group.pairs;
        std::int32_t     found = p < pairs.count ? 1 : 0;
        if (p < pairs.count && may_split(group.bodies, group.law, pairs.key[p]))
        {
            const std::int32_t had = last.of(pairs.key[p]).count;
            found                  = group(pairs.key[p], {pairs.first_node[p], pairs.first_node[p + 1]}, lanes);
            found                  = found > had ? found : had;
        }
        if (lanes.lane() == 0) { rows[p] = found; }
    }
};

/// Writes the list of pairs with the rows in place of their pair.
struct WriteRows
{
    AssignNodes         assign;
    LastRows            last;
    const std::int32_t* first; ///< [pairs + 1], after the scan

    std::uint64_t* key;
    Patch*         patch;
    Rolling*       rolling;
    Vec3<double>*  place;
    std::int32_t*  first_node;
    std::int32_t*  node;

    template<class Lanes>
    TREAD_HD void operator()(std::int64_t p, const Lanes& lanes) const
    {
        const PairsView& pairs = assign.pairs;
        if (p == pairs.count)
        {
            if (lanes.lane() == 0) { first_node[first[p]] = pairs.first_node[p]; }
            return;
        }
        const int rows = first[p + 1] - first[p];
        if (rows > 1) { divide(p, rows, lanes); }
        else { keep(p, lanes); }
    }

private:
    template<class Lanes>
    TREAD_HD void keep(std::int64_t p, const Lanes& lanes) const
    {
        const PairsView&   pairs = assign.pairs;
        const std::int32_t at    = first[p];
        for (std::int32_t i = pairs.first_node[p] + lanes.lane(); i < pairs.first_node[p + 1]; i += lanes.lanes())
        {
            node[i] = pairs.node[i];
        }
        if (lanes.lane() != 0) { return; }
        key[at]        = pairs.key[p];
        patch[at]      = pairs.patch[p];
        place[at]      = Vec3<double>::Zero();
        first_node[at] = pairs.first_node[p];
        if (rolling != nullptr) { rolling[at] = pairs.rolling[p]; }
    }

    template<class Lanes>
    TREAD_HD void divide(std::int64_t p, int rows, const Lanes& lanes) const
    {
        const PairsView&   pairs = assign.pairs;
        const std::int32_t at    = first[p];
        for (int g = lanes.lane(); g < rows; g += lanes.lanes())
        {
            key[at + g] = pairs.key[p] + static_cast<std::uint64_t>(g);
        }
        const RowRecords to{rows, patch + at, rolling == nullptr ? nullptr : rolling + at, place + at};
        assign(pairs.key[p], {pairs.first_node[p], pairs.first_node[p + 1]}, last.of(pairs.key[p]), to, node,
               first_node + at, lanes);
    }
};

/// Whether row p is the first row of a pair that may have several.
struct FirstOfSeveral
{
    BodiesView bodies;
    BodyLaw    law;
    PairsView  pairs;

    TREAD_HD bool operator()(std::int64_t p) const
    {
        return whole_pair(pairs.key[p]) == pairs.key[p] && may_split(bodies, law, pairs.key[p]);
    }
};

/// Returns the number of rows of the pair whose first row is p.
TREAD_HD int rows_of(const PairsView& pairs, std::int64_t p)
{
    int rows = 1;
    while (p + rows < pairs.count && same_pair(pairs.key[p + rows], pairs.key[p])) { ++rows; }
    return rows;
}

/// Groups the nodes of a list's pairs again and marks the pairs that need more rows than they have.
struct GroupAgain
{
    GroupNodes          group;
    std::int64_t        count;
    const std::int32_t* several;       ///< [count], first rows
    std::int32_t*       short_of_rows; ///< [count + 1]

    template<class Lanes>
    TREAD_HD void operator()(std::int64_t i, const Lanes& lanes) const
    {
        const PairsView& pairs  = group.pairs;
        std::int32_t     marked = 0;
        if (i < count)
        {
            const std::int64_t p    = several[i];
            const int          rows = rows_of(pairs, p);
            marked = group(pairs.key[p], {pairs.first_node[p], pairs.first_node[p + rows]}, lanes) > rows ? 1 : 0;
        }
        if (lanes.lane() == 0) { short_of_rows[i] = marked; }
    }
};

/// Assigns the nodes to the rows again.
struct DealAgain
{
    AssignNodes         assign;
    const std::int32_t* several;
    Vec3<double>*       place;
    std::int32_t*       first_node; ///< the list's own array
    std::int32_t*       node;       ///< the list's own array
    std::int32_t*       pair_of_node;
    std::int32_t*       scratch; ///< [nodes]

    template<class Lanes>
    TREAD_HD void operator()(std::int64_t i, const Lanes& lanes) const
    {
        const PairsView&   pairs = assign.pairs;
        const std::int64_t p     = several[i];
        const int          rows  = rows_of(pairs, p);
        if (rows == 1) { return; }
        const NodeRun    nodes{first_node[p], first_node[p + rows]};
        const RowRecords own{rows, pairs.patch + p, pairs.rolling == nullptr ? nullptr : pairs.rolling + p, place + p};
        std::int32_t     starts[most + 1];
        assign(pairs.key[p], nodes, own, own, scratch, starts, lanes);
        if (lanes.lane() != 0) { return; }
        starts[rows] = nodes.end;
        for (int g = 0; g < rows; ++g)
        {
            if (g > 0)
            {
                first_node[p + g] = starts[g];
            } // the first entry is not written: the neighbouring pair in the list reads it
            for (std::int32_t n = starts[g]; n < starts[g + 1]; ++n)
            {
                node[n]         = scratch[n];
                pair_of_node[n] = static_cast<std::int32_t>(p + g);
            }
        }
    }
};

template<class Exec>
void take_over(Pairs<Exec>& pairs)
{
    Patches<Exec>& patches = pairs.patches;
    pairs.key.swap(patches.key);
    pairs.patch.swap(patches.patch);
    if (pairs.resists_rolling) { pairs.rolling.swap(patches.rolling); }
    pairs.nodes.first.swap(patches.first_node);
    pairs.nodes.node.swap(patches.node);
}

/// Writes the rows. `run`(name, items, item function) runs an item function with a backend's lanes. Returns whether
/// some pair has several rows.
template<class Exec, class Run>
bool write_rows(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, Run run)
{
    Patches<Exec>&     patches = pairs.patches;
    const std::int64_t count   = pairs.key.size();
    patches.group.resize(pairs.nodes.node.size());
    patches.first.resize(count + 1);
    const SleepingPairsView asleep = pairs.sleep.pairs.view();
    const LastRows          last{{pairs.last.key.size(), pairs.last.key.data(), pairs.last.patch.data(),
                         pairs.resists_rolling ? pairs.last.rolling.data() : nullptr,
                         patches.last_place.size() > 0 ? patches.last_place.data() : nullptr},
                        {asleep.count, asleep.key, asleep.patch, asleep.rolling, asleep.place}};
    run("group pair nodes", count + 1,
        CountRows{{bodies, law, pairs.view(), pairs.sizes.node_area.data(), patches.group.data()},
                  last,
                  patches.first.data()});
    const std::int64_t rows = exclusive_scan(exec, patches.first, pairs.sort);
    if (rows == count) { return false; }
    patches.key.resize(rows);
    patches.patch.resize(rows);
    patches.place.resize(rows);
    patches.first_node.resize(rows + 1);
    patches.node.resize(pairs.nodes.node.size());
    if (pairs.resists_rolling) { patches.rolling.resize(rows); }
    run("write patches", count + 1,
        WriteRows{{bodies, law, pairs.view(), patches.group.data()},
                  last,
                  patches.first.data(),
                  patches.key.data(),
                  patches.patch.data(),
                  pairs.resists_rolling ? patches.rolling.data() : nullptr,
                  patches.place.data(),
                  patches.first_node.data(),
                  patches.node.data()});
    return true;
}

template<class Exec, class Run>
void split(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, Run run)
{
    if (write_rows(exec, pairs, bodies, law, run))
    {
        take_over(pairs);
        pair_steps::order_again(exec, pairs, bodies);
    }
    else { pairs.patches.place.resize(0); }
    select(exec, "pairs of several patches", pairs.key.size(), FirstOfSeveral{bodies, law, pairs.view()},
           pairs.search.found, pairs.sort, pairs.patches.several);
}

/// Whether the rows of every pair suffice; `run` as in split.
template<class Exec, class Run>
bool rows_suffice(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, Run run)
{
    Patches<Exec>&     patches = pairs.patches;
    const std::int64_t count   = patches.several.size();
    if (count == 0) { return true; }
    patches.first.resize(count + 1);
    run("group pair nodes again", count + 1,
        GroupAgain{{bodies, law, pairs.view(), pairs.sizes.node_area.data(), patches.group.data()},
                   count,
                   patches.several.data(),
                   patches.first.data()});
    return exclusive_scan(exec, patches.first, pairs.sort) == 0;
}

template<class Exec, class Run>
void regroup(Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, Run run)
{
    Patches<Exec>& patches = pairs.patches;
    if (patches.several.size() == 0 || patches.place.size() == 0) { return; }
    run("assign pair nodes again", patches.several.size(),
        DealAgain{{bodies, law, pairs.view(), patches.group.data()},
                  patches.several.data(),
                  patches.place.data(),
                  pairs.nodes.first.data(),
                  pairs.nodes.node.data(),
                  pairs.nodes.pair.data(),
                  patches.node.data()});
}

} // namespace tread::dem::patches
