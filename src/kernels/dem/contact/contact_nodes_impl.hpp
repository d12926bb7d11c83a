#pragma once

#include "backend/bits.hpp"
#include "kernels/dem/contact/contact_nodes.hpp"
#include "kernels/dem/contact/ray_field_kern.hpp"
#include "kernels/dem/contact/sphere_contact_kern.hpp"
#include "kernels/dem/pairs/pairs_kern.hpp"

// Item function of list_contact_nodes for lanes that share a pair; contact_nodes.cpp and .cu provide the lanes.
namespace tread::dem::contact_nodes
{

inline constexpr std::int32_t without_nodes = -1;

struct Count
{
    std::int32_t found = 0;

    template<class Lanes>
    TREAD_HD void operator()(bool near, std::int32_t, const Lanes& lanes)
    {
        found += count_bits(lanes.vote(near));
    }
};

struct Write
{
    std::int32_t* place;

    template<class Lanes>
    TREAD_HD void operator()(bool near, std::int32_t node, const Lanes& lanes)
    {
        const std::uint32_t all = lanes.vote(near);
        if (near) { place[count_bits(all & first_bits(lanes.lane()))] = node; }
        place += count_bits(all);
    }
};

/// Calls take(near, name of the node, lanes) for every node of the clusters that may enter; all lanes take part.
template<class Field, class Name, class Lanes, class Take>
TREAD_HD void walk(const Side<Field>& side, double way, Name name, const Lanes& lanes, Take& take)
{
    const std::int32_t clusters = side.owner.shape->cluster_count, nodes = side.owner.shape->node_count;
    for (std::int32_t base = 0; base < clusters; base += lanes.lanes())
    {
        const std::int32_t own  = base + lanes.lane();
        std::uint32_t      near = lanes.vote(own < clusters && side.near(own, way));
        for (std::int32_t cluster = base; near != 0; ++cluster, near >>= 1)
        {
            if ((near & 1u) == 0) { continue; }
            const std::int32_t last = cluster * cluster_size + cluster_size;
            for (std::int32_t first = cluster * cluster_size; first < last; first += lanes.lanes())
            {
                const std::int32_t i = first + lanes.lane();
                take(i < nodes && side.near_node(i, way), name(i), lanes);
            }
        }
    }
}

template<class Meet>
struct Walk
{
    Meet       meet;
    BodiesView bodies;
    BodyLaw    law;
    PairsView  pairs;

    /// Whether the pair consists of two exact spheres, or of one and a wall.
    TREAD_HD bool closed_form(std::int64_t p) const
    {
        const std::int64_t b = second_of(pairs.key[p]);
        return is_sphere(first_of(pairs.key[p])) && (b >= bodies.count || is_sphere(b));
    }

    TREAD_HD bool is_sphere(std::int64_t b) const { return law.templates[bodies.shape[b]].sphere_radius > 0; }

    template<class Lanes, class Take>
    TREAD_HD void operator()(std::int64_t p, const Lanes& lanes, Take& take) const
    {
        const std::int64_t a = first_of(pairs.key[p]), b = second_of(pairs.key[p]);
        Couple             couple;
        couple.body[0]      = instance_of(bodies, law.templates, a, bodies.position[a]);
        const double way    = pairs.allowed_displacement[a];
        const auto   first  = [](std::int32_t i) { return i; };
        const auto   second = [](std::int32_t i) { return ~i; };
        if (b >= bodies.count)
        {
            const PlaneField wall = field_of(law.planes[b - bodies.count], bodies.position[a]);
            walk(Side<PlaneField>{couple.body[0], wall, 1.0, 1.0}, way, first, lanes, take);
            return;
        }
        couple.body[1] = instance_of(bodies, law.templates, b, bodies.position[a]);
        const TwoSides<Meet> sides{meet, couple};
        const double         together = way + pairs.allowed_displacement[b];
        walk(sides.first(), together, first, lanes, take);
        walk(sides.second(), together, second, lanes, take);
    }
};

template<class Meet>
struct CountNodes
{
    Walk<Meet>    walk;
    std::int32_t* found; ///< [pairs]

    template<class Lanes>
    TREAD_HD void operator()(std::int64_t p, const Lanes& lanes) const
    {
        const bool closed_form = walk.closed_form(p);
        Count      count;
        if (!closed_form) { walk(p, lanes, count); }
        if (lanes.lane() == 0) { found[p] = closed_form ? without_nodes : count.found; }
    }
};

template<class Meet>
struct WriteNodes
{
    Walk<Meet>          walk;
    const std::int32_t* first; ///< [pairs + 1]
    std::int32_t*       node;

    template<class Lanes>
    TREAD_HD void operator()(std::int64_t p, const Lanes& lanes) const
    {
        if (first[p] == first[p + 1]) { return; }
        Write write{node + first[p]};
        walk(p, lanes, write);
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
