#pragma once

#include "kernels/dem/contact/patches_kern.hpp"

// Assignment of one pair's nodes to its rows of the list, by lanes that share the pair, and of the records of the rows.
namespace tread::dem::patches
{

/// The two bodies of a listed pair, with its nodes relative to the first body.
struct Contact
{
    PairLaw      law;
    Couple       couple;
    Mat3<double> to_a; ///< rotation from the world frame to a's body frame

    TREAD_HD TwoSides<MeetByDistance> sides() const { return {{}, couple}; }

    TREAD_HD Touch touch(const NodeInField& node) const
    {
        return {to_a * node.place, to_a * (node.sign * node.gradient).normalized()};
    }

    /// Returns the position of a node, m, in a's frame; the node need not be in contact.
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

/// Range of nodes.
struct NodeRun
{
    std::int32_t begin;
    std::int32_t end;
};

/// Assigns every node of a pair that may split to a patch, and returns the number of patches.
struct GroupNodes
{
    BodiesView    bodies;
    BodyLaw       law;
    PairsView     pairs;
    const double* node_area;
    std::int32_t* group; ///< patch of each node

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
    /// Adds the nodes to the groups. All lanes keep identical groups: each lane evaluates one node, and all lanes add
    /// these nodes in sequence.
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

    /// Assigns final patch numbers; nodes not yet in contact belong to the nearest patch.
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

/// Records of the rows of one pair.
struct RowRecords
{
    int           count;
    Patch*        patch;
    Rolling*      rolling; ///< null without rolling friction
    Vec3<double>* place;   ///< null if no pair has several rows
};

/// Assigns a pair's nodes to its rows, and distributes the old records by the stiffness of the nodes: each row gets the
/// share of the nodes nearest to the old row (a split conserves energy; a merge dissipates the difference).
struct AssignNodes
{
    BodiesView          bodies;
    BodyLaw             law;
    PairsView           pairs;
    const std::int32_t* group;

    /// `from` may be `to`. Nodes are written to `node`, patch after patch, each in the order of the list; `first`
    /// receives the start of each.
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
    /// Stiffness of the nodes, N/m, by their new row and by the nearest old row.
    struct Shares
    {
        double       of[most][most];
        double       last[most]; ///< sums over all new rows
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

    /// Returns the nearest of the rows with a nonzero record.
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

    /// Adds a share of an old record to that of a row: the same share of its springs' force and of their stiffness.
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
