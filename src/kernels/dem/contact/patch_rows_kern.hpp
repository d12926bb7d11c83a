#pragma once

#include "kernels/dem/contact/patches_kern.hpp"

// One pair's nodes, dealt to its rows of the list by lanes that share the pair, and what the rows remember.
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

TREAD_HD bool may_split(const BodiesView& bodies, const BodyLaw& law, std::uint64_t key)
{
    const std::int64_t a = first_of(key), b = second_of(key);
    return b < bodies.count && (law.templates[bodies.shape[a]].concave || law.templates[bodies.shape[b]].concave);
}

/// A run of nodes.
struct NodeRun
{
    std::int32_t begin;
    std::int32_t end;
};

/// Says of every node of a pair that may split which patch it is of, and how many there are.
struct GroupNodes
{
    BodiesView    bodies;
    BodyLaw       law;
    PairsView     pairs;
    const double* node_area;
    std::int32_t* group; ///< of the nodes

    template<class Lanes>
    TREAD_HD std::int32_t operator()(std::uint64_t key, const NodeRun& nodes, const Lanes& lanes) const
    {
        const Contact contact = contact_of(pairs, bodies, law, key);
        const double  area    = std::fmax(node_area[first_of(key)], node_area[second_of(key)]);
        Groups        groups;
        groups.count = 0;
        groups.gap   = gap_in_spaces * std::sqrt(area);
        for (std::int32_t base = nodes.begin; base < nodes.end; base += lanes.lanes())
        {
            add(contact, base, nodes.end, lanes, groups);
        }
        const std::int32_t found = groups.count > 1 ? groups.close() : 1;
        number(contact, nodes, found, groups, lanes);
        return found;
    }

private:
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
    TREAD_HD void number(const Contact& contact, const NodeRun& nodes, std::int32_t found, const Groups& groups,
                         const Lanes& lanes) const
    {
        for (std::int32_t i = nodes.begin + lanes.lane(); i < nodes.end; i += lanes.lanes())
        {
            if (found == 1)
            {
                group[i] = 0;
                continue;
            }
            const int of = group[i] >= 0 ? group[i] : groups.nearest(contact.place(pairs.node[i]));
            group[i]     = groups.number[of];
        }
    }
};

/// What the rows of one pair remember.
struct RowRecords
{
    int           count;
    Patch*        patch;
    Rolling*      rolling; ///< null without rolling friction
    Vec3<double>* place;   ///< null where no pair has several rows
};

/// Deals a pair's nodes to its rows, and to these what its rows remembered so far, shared by the stiffness of nodes: to
/// each what the nodes nearest to it had (a split keeps energy, two that come together lose what they differ by).
struct AssignNodes
{
    BodiesView          bodies;
    BodyLaw             law;
    PairsView           pairs;
    const std::int32_t* group;

    /// `from` may be `to`. Nodes go to `node`, patch after patch, each in the order of the list; `first` gets where.
    template<class Lanes>
    TREAD_HD void operator()(std::uint64_t key, const NodeRun& nodes, const RowRecords& from, const RowRecords& to,
                             std::int32_t* node, std::int32_t* first, const Lanes& lanes) const
    {
        const Shares shares = share(key, nodes, from, to.count, lanes);
        if (lanes.lane() != 0) { return; }
        write_nodes(nodes, to.count, node, first);
        Patch   patch[most];
        Rolling rolling[most];
        for (int o = 0; o < from.count; ++o)
        {
            patch[o]   = from.patch[o];
            rolling[o] = from.rolling != nullptr ? from.rolling[o] : no_rolling();
        }
        for (int g = 0; g < to.count; ++g)
        {
            Patch   patch_of_row   = no_patch();
            Rolling rolling_of_row = no_rolling();
            for (int o = 0; o < from.count; ++o)
            {
                const double part = shares.last[o] > 0 ? shares.of[g][o] / shares.last[o] : (g == 0 ? 1.0 : 0.0);
                if (!(part > 0)) { continue; }
                add(patch[o], part, patch_of_row);
                add(rolling[o], part, patch_of_row.normal, rolling_of_row);
            }
            to.patch[g] = patch_of_row;
            to.place[g] = shares.centre[g];
            if (to.rolling != nullptr) { to.rolling[g] = rolling_of_row; }
        }
    }

private:
    /// Stiffness of the nodes, N/m, by their row and by the row so far that they are nearest to.
    struct Shares
    {
        double       of[most][most];
        double       last[most]; ///< of all rows
        Vec3<double> centre[most];
    };

    template<class Lanes>
    TREAD_HD Shares share(std::uint64_t key, const NodeRun& nodes, const RowRecords& from, int rows,
                          const Lanes& lanes) const
    {
        const Contact contact = contact_of(pairs, bodies, law, key);
        Shares        shares;
        for (int g = 0; g < most; ++g)
        {
            shares.last[g]   = 0;
            shares.centre[g] = Vec3<double>::Zero();
            for (int o = 0; o < most; ++o) { shares.of[g][o] = 0; }
        }
        for (std::int32_t i = nodes.begin + lanes.lane(); i < nodes.end; i += lanes.lanes())
        {
            const NodeInField found = contact.sides()(pairs.node[i]);
            if (!(found.overlap > 0)) { continue; }
            const double       stiffness = found.weight * traction_at(contact.law, found.overlap).slope;
            const Vec3<double> at        = contact.to_a * found.place;
            shares.of[group[i]][nearest(from, at)] += stiffness;
            shares.centre[group[i]] += stiffness * at;
        }
        for (int g = 0; g < rows; ++g)
        {
            double total = 0;
            for (int o = 0; o < most; ++o)
            {
                shares.of[g][o] = lanes.sum(shares.of[g][o]);
                shares.last[o] += shares.of[g][o];
                total += shares.of[g][o];
            }
            for (int c = 0; c < 3; ++c) { shares.centre[g][c] = lanes.sum(shares.centre[g][c]); }
            if (total > 0) { shares.centre[g] /= total; }
        }
        return shares;
    }

    /// Of the rows that have something to remember.
    TREAD_HD static int nearest(const RowRecords& from, const Vec3<double>& at)
    {
        int    found    = 0;
        double distance = -1;
        for (int o = 0; o < from.count && from.count > 1; ++o)
        {
            if (!(from.patch[o].stiffness > 0)) { continue; }
            const double other = (from.place[o] - at).squaredNorm();
            if (distance < 0 || other < distance)
            {
                distance = other;
                found    = o;
            }
        }
        return found;
    }

    /// Adds a part of an old record to a row's: as much of its springs' force as of their stiffness.
    TREAD_HD static void add(const Patch& from, double part, Patch& to)
    {
        if (to.stiffness < part * from.stiffness)
        {
            to.tangential = turn_with_normal(to.tangential, to.normal, from.normal);
            to.normal     = from.normal;
        }
        to.tangential += turn_with_normal(part * from.tangential, from.normal, to.normal);
        to.torsion += part * from.torsion;
        to.stiffness += part * from.stiffness;
        to.twist_stiffness += part * from.twist_stiffness;
    }

    TREAD_HD static void add(const Rolling& from, double part, const Vec3<double>& normal, Rolling& to)
    {
        to.moment += part * from.moment;
        to.normal = normal;
        to.stiffness += part * from.stiffness;
    }

    TREAD_HD void write_nodes(const NodeRun& nodes, int rows, std::int32_t* node, std::int32_t* first) const
    {
        std::int32_t place = nodes.begin;
        for (int g = 0; g < rows; ++g)
        {
            first[g] = place;
            for (std::int32_t i = nodes.begin; i < nodes.end; ++i)
            {
                if (group[i] == g) { node[place++] = pairs.node[i]; }
            }
        }
    }
};

} // namespace tread::dem::patches
