#pragma once

#include "kernels/dem/contact/pair_law_kern.hpp"
#include "kernels/dem/contact/sphere_contact_kern.hpp"
#include "kernels/dem/pairs/pairs.hpp"

// Grouping of the nodes of one pair into patches, in the frame of body a, so that whatever rotates with a is unchanged.
namespace tread::dem::patches
{

inline constexpr int    most          = 4;   ///< maximum number of patches of a pair
inline constexpr int    most_open     = 8;   ///< maximum while nodes are still being added
inline constexpr double same_side     = 0.5; ///< minimum cosine of the angle between the normals of one patch
inline constexpr double gap_in_spaces = 2;   ///< maximum gap in a patch, in node spacings of the coarser body

/// A node in contact.
struct Touch
{
    Vec3<double> at;     ///< m
    Vec3<double> normal; ///< unit, towards a
};

struct Group
{
    Vec3<double> low, high; ///< m, box of the nodes
    Vec3<double> normal;    ///< sum over the nodes
};

TREAD_HD double cosine(const Vec3<double>& a, const Vec3<double>& b)
{
    const double lengths = a.norm() * b.norm();
    return lengths > 0 ? a.dot(b) / lengths : 0.0;
}

/// Returns the distance between two boxes, m; 0 if they overlap.
TREAD_HD double between(const Group& a, const Vec3<double>& low, const Vec3<double>& high)
{
    return (a.low - high).cwiseMax(low - a.high).cwiseMax(0.0).norm();
}

/// Patches of a pair while its nodes are added, in the order of the list.
struct Groups
{
    Group        group[most_open];
    std::int32_t number[most_open]; ///< number of the final patch
    int          count;
    double       gap; ///< m

    TREAD_HD int add(const Touch& touch)
    {
        for (int g = 0; g < count; ++g)
        {
            if (cosine(group[g].normal, touch.normal) >= same_side && between(group[g], touch.at, touch.at) <= gap)
            {
                return join(g, {touch.at, touch.at, touch.normal});
            }
        }
        if (count == most_open) { return join(most_alike(touch.normal), {touch.at, touch.at, touch.normal}); }
        number[count] = count;
        group[count]  = {touch.at, touch.at, touch.normal};
        return count++;
    }

    /// Merges groups that have grown together, then the most similar ones until few enough are left, and numbers these.
    /// Returns their number.
    TREAD_HD int close()
    {
        int left = count;
        for (bool joined = true; joined;)
        {
            joined = false;
            for (int a = 0; a < count && !joined; ++a)
            {
                for (int b = a + 1; b < count && !joined; ++b)
                {
                    joined = open(a) && open(b) && cosine(group[a].normal, group[b].normal) >= same_side &&
                             between(group[a], group[b].low, group[b].high) <= gap;
                    if (joined) { merge(a, b); }
                }
            }
            left -= joined ? 1 : 0;
        }
        for (; left > most; --left) { merge_most_alike(); }
        return renumber();
    }

    TREAD_HD int nearest(const Vec3<double>& at) const
    {
        int    found    = 0;
        double distance = between(group[0], at, at);
        for (int g = 1; g < count; ++g)
        {
            const double other = between(group[g], at, at);
            if (other < distance)
            {
                distance = other;
                found    = g;
            }
        }
        return found;
    }

private:
    TREAD_HD bool open(int g) const { return number[g] == g; }

    TREAD_HD int join(int g, const Group& other)
    {
        group[g].low  = group[g].low.cwiseMin(other.low);
        group[g].high = group[g].high.cwiseMax(other.high);
        group[g].normal += other.normal;
        return g;
    }

    TREAD_HD void merge(int a, int b)
    {
        join(a, group[b]);
        for (int g = 0; g < count; ++g)
        {
            if (number[g] == b) { number[g] = a; }
        }
    }

    TREAD_HD int most_alike(const Vec3<double>& normal) const
    {
        int found = 0;
        for (int g = 1; g < count; ++g)
        {
            if (cosine(group[g].normal, normal) > cosine(group[found].normal, normal)) { found = g; }
        }
        return found;
    }

    TREAD_HD void merge_most_alike()
    {
        int    first = -1, second = -1;
        double best = -2;
        for (int a = 0; a < count; ++a)
        {
            for (int b = a + 1; b < count; ++b)
            {
                const double alike = open(a) && open(b) ? cosine(group[a].normal, group[b].normal) : -2.0;
                if (alike > best)
                {
                    best   = alike;
                    first  = a;
                    second = b;
                }
            }
        }
        merge(first, second);
    }

    /// Numbers the final groups; merged groups refer to a group with a lower index.
    TREAD_HD int renumber()
    {
        int left = 0;
        for (int g = 0; g < count; ++g) { number[g] = open(g) ? left++ : number[number[g]]; }
        return left;
    }
};

} // namespace tread::dem::patches
