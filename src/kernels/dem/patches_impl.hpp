#pragma once

#include "kernels/dem/pairs_impl.hpp"
#include "kernels/dem/patches.hpp"
#include "kernels/dem/patches_kern.hpp"

// The steps of split_patches, for lanes that share a pair; patches.cpp and patches.cu bring in for_each and the lanes.
namespace tread::dem::patches
{

/// The two bodies of a listed pair, and what its nodes look like from the first.
struct Contact
{
    PairLaw      law;
    Couple       couple;
    Mat3<double> to_a; ///< from the world's axes to those of a

    TREAD_HD TwoSides<MeetByDistance> sides() const { return {{}, couple}; }

    TREAD_HD Touch touch(const NodeInField& node) const
    {
        return {to_a * node.place, to_a * (node.sign * node.gradient).normalized()};
    }

    /// m, of a node that need not touch.
    TREAD_HD Vec3<double> place(std::int32_t node) const
    {
        return to_a * (node >= 0 ? sides().first().node(node) : sides().second().node(~node));
    }
};

TREAD_HD Contact contact_of(const PairsView& pairs, const BodiesView& bodies, const BodyLaw& law, std::uint64_t key)
{
    const std::int64_t a = first_of(key), b = second_of(key);
    const Instance     of_a = instance_of(bodies, law.templates, a, bodies.position[a]);
    const Instance     of_b = instance_of(bodies, law.templates, b, bodies.position[a]);
    return {law_of(pairs, law, bodies.count, key), {{of_a, of_b}}, of_a.rotation.transpose()};
}

/// Says of every listed node which patch of its pair it is of, where the pair has several, and how many it has.
struct GroupNodes
{
    BodiesView    bodies;
    BodyLaw       law;
    PairsView     pairs;
    const double* node_area;
    std::int32_t* group; ///< of the nodes
    std::int32_t* count; ///< [pairs + 1]

    template<class Lanes>
    TREAD_HD void operator()(std::int64_t p, const Lanes& lanes) const
    {
        std::int32_t found = p < pairs.count ? 1 : 0;
        if (p < pairs.count && may_split(pairs.key[p])) { found = split(p, lanes); }
        if (lanes.lane() == 0) { count[p] = found; }
    }

private:
    TREAD_HD bool may_split(std::uint64_t key) const
    {
        const std::int64_t a = first_of(key), b = second_of(key);
        return b < bodies.count && (law.templates[bodies.shape[a]].concave || law.templates[bodies.shape[b]].concave);
    }

    template<class Lanes>
    TREAD_HD std::int32_t split(std::int64_t p, const Lanes& lanes) const
    {
        const Contact contact = contact_of(pairs, bodies, law, pairs.key[p]);
        const double  area    = std::fmax(node_area[first_of(pairs.key[p])], node_area[second_of(pairs.key[p])]);
        Groups        groups;
        groups.count = 0;
        groups.gap   = gap_in_spaces * std::sqrt(area);
        for (std::int32_t base = pairs.first_node[p]; base < pairs.first_node[p + 1]; base += lanes.lanes())
        {
            add(contact, base, pairs.first_node[p + 1], lanes, groups);
        }
        const std::int32_t found = groups.count > 1 ? groups.close() : 1;
        if (found > 1) { number(contact, p, groups, lanes); }
        return found;
    }

    /// All lanes keep the same groups: each looks up a node, and all add them one after the other.
    template<class Lanes>
    TREAD_HD void add(const Contact& contact, std::int32_t base, std::int32_t end, const Lanes& lanes,
                      Groups& groups) const
    {
        const std::int32_t own = base + lanes.lane();
        Touch              mine{Vec3<double>::Zero(), Vec3<double>::Zero()};
        bool               touches = false;
        if (own < end)
        {
            const NodeInField node = contact.sides()(pairs.node[own]);
            mine                   = contact.touch(node);
            touches                = node.overlap > 0;
            group[own]             = -1;
        }
        std::uint32_t left = lanes.vote(touches);
        for (std::int32_t lane = 0; left != 0; ++lane, left >>= 1)
        {
            if ((left & 1u) == 0) { continue; }
            const int joined = groups.add({from(lanes, lane, mine.at), from(lanes, lane, mine.normal)});
            if (lane == lanes.lane()) { group[own] = joined; }
        }
    }

    template<class Lanes>
    TREAD_HD static Vec3<double> from(const Lanes& lanes, std::int32_t lane, const Vec3<double>& value)
    {
        return {lanes.from(lane, value[0]), lanes.from(lane, value[1]), lanes.from(lane, value[2])};
    }

    /// Nodes that do not touch yet are of the nearest patch.
    template<class Lanes>
    TREAD_HD void number(const Contact& contact, std::int64_t p, const Groups& groups, const Lanes& lanes) const
    {
        for (std::int32_t i = pairs.first_node[p] + lanes.lane(); i < pairs.first_node[p + 1]; i += lanes.lanes())
        {
            const int of = group[i] >= 0 ? group[i] : groups.nearest(contact.place(pairs.node[i]));
            group[i]     = groups.number[of];
        }
    }
};

/// The list of pairs with the patches in the place of their pair.
struct WritePatches
{
    BodiesView          bodies;
    BodyLaw             law;
    PairsView           pairs;
    const std::int32_t* group;
    const std::int32_t* first; ///< [pairs + 1], after the scan

    std::int64_t         last_count;
    const std::uint64_t* last_key;
    const Patch*         last_patch;
    const Rolling*       last_rolling; ///< null without rolling friction, like those of the list
    const Vec3<double>*  last_place;

    std::uint64_t* key;
    Patch*         patch;
    Rolling*       rolling;
    Vec3<double>*  place;
    std::int32_t*  first_node;
    std::int32_t*  node;

    template<class Lanes>
    TREAD_HD void operator()(std::int64_t p, const Lanes& lanes) const
    {
        if (p == pairs.count)
        {
            if (lanes.lane() == 0) { first_node[first[p]] = pairs.first_node[p]; }
            return;
        }
        const std::int64_t start = lower_bound(last_key, last_count, pairs.key[p]);
        std::int64_t       end   = start;
        while (end < last_count && same_pair(last_key[end], pairs.key[p])) { ++end; }
        if (first[p + 1] - first[p] > 1 || end - start > 1) { divide(p, start, end, lanes); }
        else { keep(p, lanes); }
    }

private:
    template<class Lanes>
    TREAD_HD void keep(std::int64_t p, const Lanes& lanes) const
    {
        const std::int32_t at = first[p];
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

    /// Stiffness of the nodes, N/m, by their patch and by the last list's patch that they are nearest to.
    struct Shares
    {
        double       of[most][most];
        double       last[most];  ///< of all patches
        double       total[most]; ///< of each patch
        Vec3<double> centre[most];
    };

    template<class Lanes>
    TREAD_HD void divide(std::int64_t p, std::int64_t start, std::int64_t end, const Lanes& lanes) const
    {
        const int    count  = first[p + 1] - first[p];
        const Shares shares = share(p, start, end, count, lanes);
        if (lanes.lane() != 0) { return; }
        write_nodes(p, count);
        for (int g = 0; g < count; ++g)
        {
            const std::int32_t at = first[p] + g;
            key[at]               = pairs.key[p] + static_cast<std::uint64_t>(g);
            place[at]             = shares.centre[g];
            patch[at]             = no_patch();
            if (rolling != nullptr) { rolling[at] = no_rolling(); }
            for (int o = 0; o < static_cast<int>(end - start); ++o)
            {
                const double part = shares.last[o] > 0 ? shares.of[g][o] / shares.last[o] : (g == 0 ? 1.0 : 0.0);
                if (part > 0) { take(start + o, part, at); }
            }
        }
    }

    template<class Lanes>
    TREAD_HD Shares share(std::int64_t p, std::int64_t start, std::int64_t end, int count, const Lanes& lanes) const
    {
        const Contact contact = contact_of(pairs, bodies, law, pairs.key[p]);
        Shares        shares;
        for (int g = 0; g < most; ++g)
        {
            shares.last[g] = shares.total[g] = 0;
            shares.centre[g]                 = Vec3<double>::Zero();
            for (int o = 0; o < most; ++o) { shares.of[g][o] = 0; }
        }
        for (std::int32_t i = pairs.first_node[p] + lanes.lane(); i < pairs.first_node[p + 1]; i += lanes.lanes())
        {
            const NodeInField found = contact.sides()(pairs.node[i]);
            if (!(found.overlap > 0)) { continue; }
            const double       stiffness = found.weight * traction_at(contact.law, found.overlap).slope;
            const Vec3<double> at        = contact.to_a * found.place;
            const int          g         = count > 1 ? group[i] : 0;
            shares.of[g][nearest_last(start, end, at)] += stiffness;
            shares.centre[g] += stiffness * at;
        }
        for (int g = 0; g < count; ++g)
        {
            for (int o = 0; o < most; ++o)
            {
                shares.of[g][o] = lanes.sum(shares.of[g][o]);
                shares.last[o] += shares.of[g][o];
                shares.total[g] += shares.of[g][o];
            }
            for (int c = 0; c < 3; ++c) { shares.centre[g][c] = lanes.sum(shares.centre[g][c]); }
            if (shares.total[g] > 0) { shares.centre[g] /= shares.total[g]; }
        }
        return shares;
    }

    TREAD_HD int nearest_last(std::int64_t start, std::int64_t end, const Vec3<double>& at) const
    {
        int    found    = 0;
        double distance = 0;
        for (std::int64_t o = start; o < end && end - start > 1; ++o)
        {
            const double other = (last_place[o] - at).squaredNorm();
            if (o == start || other < distance)
            {
                distance = other;
                found    = static_cast<int>(o - start);
            }
        }
        return found;
    }

    /// Adds a part of an old record to a patch: as much of its springs' force as of their stiffness.
    TREAD_HD void take(std::int64_t last, double part, std::int32_t at) const
    {
        const Patch& from = last_patch[last];
        Patch&       to   = patch[at];
        if (to.stiffness < part * from.stiffness)
        {
            to.tangential = turn_with_normal(to.tangential, to.normal, from.normal);
            to.normal     = from.normal;
        }
        to.tangential += turn_with_normal(part * from.tangential, from.normal, to.normal);
        to.torsion += part * from.torsion;
        to.stiffness += part * from.stiffness;
        to.twist_stiffness += part * from.twist_stiffness;
        if (rolling == nullptr) { return; }
        rolling[at].moment += part * last_rolling[last].moment;
        rolling[at].normal = to.normal;
        rolling[at].stiffness += part * last_rolling[last].stiffness;
    }

    /// Patch after patch, each in the order of the list.
    TREAD_HD void write_nodes(std::int64_t p, int count) const
    {
        std::int32_t place_of = pairs.first_node[p];
        for (int g = 0; g < count; ++g)
        {
            first_node[first[p] + g] = place_of;
            for (std::int32_t i = pairs.first_node[p]; i < pairs.first_node[p + 1]; ++i)
            {
                if (count == 1 || group[i] == g) { node[place_of++] = pairs.node[i]; }
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
    pairs.first_node.swap(patches.first_node);
    pairs.node.swap(patches.node);
}

/// `run`(name, items, item function) runs an item function with a backend's lanes.
template<class Exec, class Run>
void split(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, Run run)
{
    Patches<Exec>&     patches = pairs.patches;
    const std::int64_t count   = pairs.key.size();
    patches.group.resize(pairs.node.size());
    patches.first.resize(count + 1);
    run("group pair nodes", count + 1,
        GroupNodes{bodies, law, pairs.view(), pairs.node_area.data(), patches.group.data(), patches.first.data()});
    const std::int64_t found = exclusive_scan(exec, patches.first, pairs.sort);
    if (found == count && patches.last_place.size() == 0)
    {
        patches.place.resize(0);
        return;
    }
    patches.key.resize(found);
    patches.patch.resize(found);
    patches.place.resize(found);
    patches.first_node.resize(found + 1);
    patches.node.resize(pairs.node.size());
    if (pairs.resists_rolling) { patches.rolling.resize(found); }
    run("write patches", count + 1,
        WritePatches{bodies, law, pairs.view(), patches.group.data(), patches.first.data(), pairs.last_key.size(),
                     pairs.last_key.data(), pairs.last_patch.data(), pairs.last_rolling.data(),
                     patches.last_place.data(), patches.key.data(), patches.patch.data(),
                     pairs.resists_rolling ? patches.rolling.data() : nullptr, patches.place.data(),
                     patches.first_node.data(), patches.node.data()});
    take_over(pairs);
    if (found > count) { pair_steps::order_again(exec, pairs, bodies); }
    else { patches.place.resize(0); }
}

} // namespace tread::dem::patches
