#pragma once

#include "backend/bits.hpp"
#include "kernels/dem/contact/contact_nodes.hpp"
#include "kernels/dem/contact/near_nodes_kern.hpp"
#include "kernels/dem/contact/ray_field_kern.hpp"
#include "kernels/dem/contact/sphere_contact_kern.hpp"
#include "kernels/dem/pairs/pairs_kern.hpp"

// Item function of list_contact_nodes for lanes that share a pair; contact_nodes.cpp and .cu provide the lanes.
namespace tread::dem::contact_nodes
{

inline constexpr std::int32_t without_nodes = -1;

/// Counts the nodes of a pair, and records the clusters that they are in, as far as there is room.
struct Count
{
    NearCluster* near; ///< [near_clusters]
    std::int32_t found    = 0;
    std::int32_t clusters = 0;

    template<class Lanes>
    TREAD_HD void operator()(const NearCluster& cluster, const Lanes& lanes)
    {
        found += count_bits(cluster.nodes);
        if (clusters < near_clusters && lanes.lane() == 0) { near[clusters] = cluster; }
        ++clusters;
    }

    /// Marks the end of the record, and at its last place that it is complete.
    template<class Lanes>
    TREAD_HD void end(const Lanes& lanes) const
    {
        if (clusters < near_clusters && lanes.lane() == 0) { near[clusters] = near[near_clusters - 1] = {0, 0}; }
    }
};

struct Write
{
    std::int32_t* place;

    template<class Lanes>
    TREAD_HD void operator()(const NearCluster& cluster, const Lanes& lanes)
    {
        for (std::int32_t bit = lanes.lane(); bit < cluster_size; bit += lanes.lanes())
        {
            if ((cluster.nodes >> bit & 1u) == 0) { continue; }
            place[count_bits(cluster.nodes & first_bits(bit))] =
                cluster.first_body() ? cluster.index() * cluster_size + bit : ~(cluster.index() * cluster_size + bit);
        }
        place += count_bits(cluster.nodes);
    }
};

/// Whether a pair consists of two exact spheres, or of one and a wall.
TREAD_HD bool closed_form(const BodiesView& bodies, const BodyLaw& law, std::uint64_t key)
{
    const auto is_sphere = [&](std::int64_t b) { return law.templates[bodies.shape[b]].sphere_radius > 0; };
    return is_sphere(first_of(key)) && (second_of(key) >= bodies.count || is_sphere(second_of(key)));
}

/// Places the nodes of both sides of a pair.
template<class Meet>
struct PlaceNodes
{
    Meet         meet;
    BodiesView   bodies;
    BodyLaw      law;
    PairsView    pairs;
    PlacedNodes* placed; ///< [2 * pairs]

    TREAD_HD void operator()(std::int64_t p) const
    {
        const std::uint64_t key = pairs.key[p];
        if (closed_form(bodies, law, key)) { return; }
        const std::int64_t a = first_of(key), b = second_of(key);
        Couple             couple;
        couple.body[0] = instance_of(bodies, law.templates, a, bodies.position[a]);
        if (b >= bodies.count)
        {
            const PlaneField wall = field_of(law.planes[b - bodies.count], bodies.position[a]);
            placed[2 * p] = place_nodes(Side<PlaneField>{couple.body[0], wall, 1.0, 1.0}, pairs.allowed.way_of(a));
            return;
        }
        couple.body[1] = instance_of(bodies, law.templates, b, bodies.position[a]);
        const TwoSides<Meet> sides{meet, couple};
        const double         together = pair_reach(bodies, law.templates, pairs.allowed, a, b).approach;
        placed[2 * p]                 = place_nodes(sides.first(), together);
        placed[2 * p + 1]             = place_nodes(sides.second(), together);
    }
};

/// Walks through the clusters of a pair with nodes that may enter.
struct Walk
{
    BodiesView         bodies;
    BodyLaw            law;
    PairsView          pairs;
    const PlacedNodes* placed; ///< [2 * pairs], of the pairs as they were counted

    /// Calls take(cluster, lanes) for each of them; all lanes take part. `counted`: place of the pair when it was
    /// counted.
    template<class Lanes, class Take>
    TREAD_HD void operator()(std::int64_t p, std::int64_t counted, const Lanes& lanes, Take& take) const
    {
        const std::int64_t  a = first_of(pairs.key[p]), b = second_of(pairs.key[p]);
        const TemplateView* first  = law.templates + bodies.shape[a];
        const TemplateView* second = b < bodies.count ? law.templates + bodies.shape[b] : nullptr;
        walk(near_nodes(first, second, placed[2 * counted]), Owner::first, lanes, take);
        if (second != nullptr) { walk(near_nodes(second, first, placed[2 * counted + 1]), Owner::second, lanes, take); }
    }

private:
    enum class Owner : std::int8_t
    {
        first,
        second
    };

    /// Returns which of `count` parts from `first` have nodes that may enter, a bit each.
    template<class Lanes>
    TREAD_HD static std::uint32_t near_parts(const NearNodes& side, std::int32_t first, std::int32_t count,
                                             const Lanes& lanes)
    {
        std::uint32_t near = 0;
        for (std::int32_t bit = lanes.lane(); bit < count; bit += lanes.lanes())
        {
            const std::int32_t part = first + bit;
            near |= lanes.vote(part < side.shape->part_count && side.has_part(part)) << (bit - lanes.lane());
        }
        return near;
    }

    template<class Lanes, class Take>
    TREAD_HD static void walk(const NearNodes& side, Owner owner, const Lanes& lanes, Take& take)
    {
        constexpr std::int32_t parts = cluster_size / part_size; // of a cluster
        const std::int32_t     nodes = side.shape->node_count, step = lanes.lanes() < parts ? 1 : lanes.lanes() / parts;
        for (std::int32_t base = 0; base * cluster_size < nodes; base += step)
        {
            std::uint32_t near = near_parts(side, base * parts, step * parts, lanes);
            for (std::int32_t cluster = base; near != 0; ++cluster, near >>= parts)
            {
                if ((near & first_bits(parts)) == 0) { continue; }
                std::uint32_t all = 0;
                for (std::int32_t bit = lanes.lane(); bit < cluster_size; bit += lanes.lanes())
                {
                    const std::int32_t i       = cluster * cluster_size + bit;
                    const bool         in_part = (near >> bit / part_size & 1u) != 0;
                    all |= lanes.vote(in_part && i < nodes && side.has_node(i)) << (bit - lanes.lane());
                }
                if (all != 0) { take(NearCluster{owner == Owner::first ? cluster : ~cluster, all}, lanes); }
            }
        }
    }
};

struct CountNodes
{
    Walk          walk;
    std::int32_t* found; ///< [pairs]
    NearCluster*  near;  ///< [pairs * near_clusters]

    template<class Lanes>
    TREAD_HD void operator()(std::int64_t p, const Lanes& lanes) const
    {
        const bool exact = closed_form(walk.bodies, walk.law, walk.pairs.key[p]);
        Count      count{near + p * near_clusters};
        if (!exact) { walk(p, p, lanes, count); }
        count.end(lanes);
        if (lanes.lane() == 0) { found[p] = exact ? without_nodes : count.found; }
    }
};

struct WriteNodes
{
    Walk                walk;
    const NearCluster*  near;    ///< as CountNodes has recorded it
    const std::int32_t* counted; ///< [pairs], where a pair was when it was counted
    const std::int32_t* first;   ///< [pairs + 1]
    std::int32_t*       node;

    template<class Lanes>
    TREAD_HD void operator()(std::int64_t p, const Lanes& lanes) const
    {
        if (first[p] == first[p + 1]) { return; }
        Write              write{node + first[p]};
        const NearCluster* record = near + std::int64_t{counted[p]} * near_clusters;
        if (record[near_clusters - 1].nodes != 0) // as many as there is room for, or more
        {
            walk(p, counted[p], lanes, write);
            return;
        }
        for (std::int32_t c = 0; record[c].nodes != 0; ++c) { write(record[c], lanes); }
    }
};

/// Evaluates the nodes of one word of pairs.inside.
template<class Meet>
struct EvaluateNodes
{
    Meet         meet;
    std::int64_t bodies; ///< number of bodies
    BodyLaw      law;
    PairsView    pairs;

    template<class Lanes>
    TREAD_HD void operator()(std::int64_t word, const Lanes& lanes) const
    {
        std::uint32_t all = 0;
        for (std::int32_t bit = 0; bit < nodes_of_word; bit += lanes.lanes())
        {
            const std::int64_t i = word * nodes_of_word + bit + lanes.lane();
            all |= lanes.vote(i < pairs.node_count && inside(i)) << bit;
        }
        if (lanes.lane() == 0) { pairs.inside[word] = all; }
    }

private:
    TREAD_HD bool inside(std::int64_t i) const
    {
        const FoundNode found = packed(find(i));
        pairs.found_node[i]   = found;
        return found.overlap > 0;
    }

    TREAD_HD NodeInField find(std::int64_t i) const
    {
        const std::uint64_t key = pairs.key[pairs.pair_of_node[i]];
        const std::int64_t  a = first_of(key), b = second_of(key);
        const bool          second = pairs.node[i] < 0;
        const std::int32_t  node   = second ? ~pairs.node[i] : pairs.node[i];
        const Vec3<double>  origin = pairs.body[a].position;
        const Instance      owner  = instance_of(load(pairs.body + (second ? b : a)), law.templates, origin);
        if (b >= bodies)
        {
            return in_field(Side<PlaneField>{owner, field_of(law.planes[b - bodies], origin), 1.0, 1.0}, node);
        }
        const Instance other = instance_of(load(pairs.body + (second ? a : b)), law.templates, origin);
        return in_field(meet.side(owner, other, second ? -1.0 : 1.0), node);
    }
};

} // namespace tread::dem::contact_nodes

namespace tread::dem
{

/// Places the nodes of every pair.
template<class Exec>
void place_pair_nodes(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    by_narrow_phase(
        law,
        [&]<class Meet>(const Meet& meet)
        {
            for_each(exec, "place pair nodes", pairs.key.size(),
                     contact_nodes::PlaceNodes<Meet>{meet, bodies, law, pairs.view(), pairs.search.placed.data()});
        });
}

template<class Exec>
contact_nodes::CountNodes counting_of_nodes(Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    return {
        {bodies, law, pairs.view(), pairs.search.placed.data()}, pairs.nodes.first.data(), pairs.search.near.data()};
}

template<class Exec>
contact_nodes::WriteNodes writing_of_nodes(Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    return {{bodies, law, pairs.view(), pairs.search.placed.data()},
            pairs.search.near.data(),
            pairs.search.counted.data(),
            pairs.nodes.first.data(),
            pairs.nodes.node.data()};
}

} // namespace tread::dem
