#pragma once

#include <cmath>
#include <vector>

#include "world/world.hpp"

// Neighbour search among bodies while a world is built.
namespace tread::world
{

double bounding_radius(const World& world, std::size_t body);

/// Box around a body's mesh along the world's axes, about its centre of mass, m at scale 1.
shape::Bounds turned_box(const World& world, std::size_t body);

/// Signed distance (m) from a point (world frame) to a body's surface, negative inside.
double distance(const World& world, std::size_t body, const Vec3<double>& x);

/// Spatial hash of bodies by the cell of their centre, one lattice for each size class (bounding diameters from 2^k to
/// 2^(k+1) m), so that the cost does not depend on the grading of rocks. Cells share buckets; a visitor may see a body
/// twice.
class BodyGrid
{
public:
    explicit BodyGrid(const World& world)
        : world_(world)
    {
    }

    void add(std::size_t body);

    /// Whether visit(body) is true for a body whose bounding sphere is within `radius` of x; stops at the first.
    template<class Visit>
    bool any_near(const Vec3<double>& x, double radius, Visit&& visit) const
    {
        for (const SizeClass& level : classes_)
        {
            if (any_near_in(level, x, radius, visit)) { return true; }
        }
        return false;
    }

private:
    struct Entry
    {
        Vec3<double> centre;
        double       radius; ///< m, of the bounding sphere
        std::size_t  body;
        std::int32_t next; ///< next entry in the bucket, -1 = last
    };

    struct SizeClass
    {
        int                       exponent;
        double                    width; ///< m, width of a cell: at least the largest bounding diameter of the class
        std::vector<Entry>        entries;
        std::vector<std::int32_t> buckets; ///< first entry, -1 = none; the number of buckets is a power of two
    };

    static std::size_t bucket(const SizeClass& level, long i, long j, long k)
    {
        // Odd multipliers of Teschner et al. 2003 (VMV), mixed once more so that the low bits depend on all.
        std::uint64_t hash = static_cast<std::uint64_t>(i) * 73856093u ^ static_cast<std::uint64_t>(j) * 19349663u ^
                             static_cast<std::uint64_t>(k) * 83492791u;
        hash ^= hash >> 17;
        hash *= 0x9e3779b97f4a7c15ull;
        return static_cast<std::size_t>(hash >> 32) & (level.buckets.size() - 1);
    }

    static long cell(const SizeClass& level, double x) { return static_cast<long>(std::floor(x / level.width)); }

    template<class Visit>
    static bool any_near_in(const SizeClass& level, const Vec3<double>& x, double radius, Visit& visit)
    {
        const double reach = radius + 0.5 * level.width;
        for (long k = cell(level, x[2] - reach); k <= cell(level, x[2] + reach); ++k)
        {
            for (long j = cell(level, x[1] - reach); j <= cell(level, x[1] + reach); ++j)
            {
                for (long i = cell(level, x[0] - reach); i <= cell(level, x[0] + reach); ++i)
                {
                    if (any_in_bucket(level, bucket(level, i, j, k), x, radius, visit)) { return true; }
                }
            }
        }
        return false;
    }

    template<class Visit>
    static bool any_in_bucket(const SizeClass& level, std::size_t bucket, const Vec3<double>& x, double radius,
                              Visit& visit)
    {
        for (std::int32_t at = level.buckets[bucket]; at >= 0;)
        {
            const Entry& entry = level.entries[static_cast<std::size_t>(at)];
            const double reach = radius + entry.radius;
            if ((entry.centre - x).squaredNorm() < reach * reach && visit(entry.body)) { return true; }
            at = entry.next;
        }
        return false;
    }

    static void link(SizeClass& level, std::size_t entry);

    const World&           world_;
    std::vector<SizeClass> classes_;
};

/// Whether two bodies are at least `margin` (m) apart, testing the surface nodes of each by the other's signed
/// distance, as body-body contact does. Thin parts may intersect between nodes.
bool apart(const World& world, std::size_t one, std::size_t other, double margin);

} // namespace tread::world
