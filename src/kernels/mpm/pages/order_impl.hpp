#pragma once

#include "kernels/mpm/pages/order.hpp"

// Steps of order_points, for both backends; order.cpp and order.cu provide for_each and instantiate.
namespace tread::mpm
{
namespace order_steps
{

/// Distance outside the domain beyond which points are dropped, in spacings.
constexpr double drop_margin = 2;

template<class Real>
struct MakeKeys
{
    PointsView<Real> points;
    GridGeometry     geometry;
    std::uint64_t*   keys;
    std::int32_t*    order;

    TREAD_HD void operator()(std::int64_t i) const
    {
        const Vec3<double> x      = points.position.get(i);
        const double       margin = drop_margin * geometry.spacing;
        bool               inside = true;
        for (int c = 0; c < 3; ++c)
        {
            inside = inside && x[c] >= -margin && (c == 2 || x[c] <= geometry.size[c] + margin);
        }
        keys[i]  = inside ? cell_key(finest_cell(geometry.lattice(), geometry.refinement, x)) : no_page;
        order[i] = static_cast<std::int32_t>(i);
    }
};

template<class T>
struct Gather
{
    const T*            from;
    T*                  to;
    const std::int32_t* order;

    TREAD_HD void operator()(std::int64_t i) const { to[i] = from[order[i]]; }
};

struct MarkFirstOfPage
{
    const std::uint64_t* keys;
    std::int32_t*        marks;
    int                  shift; ///< number of bits of the key below the page

    TREAD_HD void operator()(std::int64_t i) const
    {
        marks[i] = keys[i] != no_page && (i == 0 || keys[i] >> shift != keys[i - 1] >> shift);
    }
};

/// Writes the pages: after the scan marks[i] is the number of heads before i, and a head writes its page.
struct WritePages
{
    const std::uint64_t* keys;
    const std::int32_t*  heads_before;
    std::uint64_t*       page_key;
    int                  shift;

    TREAD_HD void operator()(std::int64_t i) const
    {
        if (keys[i] == no_page || (i > 0 && keys[i] >> shift == keys[i - 1] >> shift)) { return; }
        page_key[heads_before[i]] = keys[i] >> shift;
    }
};

/// Finds the first point of page i of `pages`; the last i is that of the points outside the domain, which have the
/// largest key.
struct FirstOfPage
{
    const std::uint64_t* keys;
    std::int64_t         points;
    std::int64_t         pages;
    const std::uint64_t* page_key;
    std::int32_t*        first_point;

    TREAD_HD void operator()(std::int64_t i) const
    {
        first_point[i] = static_cast<std::int32_t>(lower_bound(keys, points, i < pages ? page_key[i] << 6 : no_page));
    }
};

struct ListInOrder
{
    const std::uint64_t* keys;
    std::int32_t*        point_at;
    std::uint8_t*        place_at;

    TREAD_HD void operator()(std::int64_t i) const
    {
        point_at[i] = static_cast<std::int32_t>(i);
        place_at[i] = static_cast<std::uint8_t>(keys[i] & 63);
    }
};

struct ListAsInMemory
{
    std::int32_t* point_at;

    TREAD_HD void operator()(std::int64_t i) const { point_at[i] = static_cast<std::int32_t>(i); }
};

struct FirstOfCell
{
    const std::uint64_t* keys;
    std::int64_t         points;
    std::int64_t         pages;
    const std::uint64_t* page_key;
    const std::int32_t*  first_point;
    std::int32_t*        cell_first_point;

    TREAD_HD void operator()(std::int64_t i) const
    {
        const std::int64_t page = i / page_cells;
        if (page == pages)
        {
            cell_first_point[i] = static_cast<std::int32_t>(points);
            return;
        }
        const std::int64_t  begin = first_point[page], end = first_point[page + 1];
        const std::uint64_t wanted = page_key[page] << 6 | static_cast<std::uint64_t>(i % page_cells);
        cell_first_point[i]        = static_cast<std::int32_t>(begin + lower_bound(keys + begin, end - begin, wanted));
    }
};

/// Distance of a point from a face of its page, in cells, within which the page beyond is listed as well.
constexpr int surround_reach = 2;

/// Whether a cell of a page (place 0..63) is within that distance of the neighbour in a direction, along every axis.
TREAD_HD bool reaches(int place, int direction)
{
    const int at[]   = {place & 3, place >> 2 & 3, place >> 4};
    const int step[] = {direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 - 1};
    for (int c = 0; c < 3; ++c)
    {
        if (step[c] < 0 && at[c] >= surround_reach) { return false; }
        if (step[c] > 0 && at[c] < page_edge - surround_reach) { return false; }
    }
    return true;
}

/// Keys of the pages around those with points, into which points may move before they are reordered; pages where no
/// point may be are excluded.
struct SurroundingKeys
{
    const std::uint64_t* page_key;
    const std::uint64_t* point_keys; ///< sorted
    std::int64_t         points;
    GridGeometry         geometry;
    std::uint64_t*       keys;
    std::int32_t*        order;

    /// Whether a point of the page is within that distance of its neighbour.
    TREAD_HD bool wanted(std::uint64_t key, int direction) const
    {
        const std::int64_t first = lower_bound(point_keys, points, key << 6);
        for (std::int64_t i = first; i < points && point_keys[i] >> 6 == key; ++i)
        {
            if (reaches(static_cast<int>(point_keys[i] & 63), direction)) { return true; }
        }
        return false;
    }

    TREAD_HD void operator()(std::int64_t i) const
    {
        const std::uint64_t own       = page_key[i / directions];
        const int           direction = static_cast<int>(i % directions);
        const Index3        page      = page_towards(page_coordinates(own), direction);
        const Lattice       lattice   = level_lattice(geometry.lattice(), level_of(page));
        const double        edge = page_edge * lattice.spacing, shift = lattice.node_shift * lattice.spacing;
        const double        corner[] = {page.x * edge + shift, page.y * edge + shift, page.z * edge + shift};
        bool                inside   = true;
        for (int c = 0; c < 3; ++c)
        {
            const double margin = (drop_margin + 1) * geometry.spacing;
            inside = inside && corner[c] + edge >= -margin && (c == 2 || corner[c] <= geometry.size[c] + margin);
        }
        keys[i]  = inside && wanted(own, direction) ? tread::mpm::page_key(page) : no_page;
        order[i] = 0;
    }
};

struct NeighbourKeys
{
    const std::uint64_t* page_key;
    std::uint64_t*       keys;
    std::int32_t*        order;

    TREAD_HD void operator()(std::int64_t i) const
    {
        keys[i]  = tread::mpm::page_key(page_at_octant(page_coordinates(page_key[i / 8]), static_cast<int>(i % 8)));
        order[i] = 0;
    }
};

/// Keys of the node pages of the level below that contain the parents of a point page's nodes, if some of these nodes
/// are slaves of that level (seams.hpp).
struct ParentKeys
{
    const std::uint64_t* page_key;
    Refinement           refinement;
    std::uint64_t*       keys;
    std::int32_t*        order;

    TREAD_HD void operator()(std::int64_t i) const
    {
        const Index3 page  = page_coordinates(page_key[i / 8]);
        const Index3 last  = node_at(page, page_cells - 1);
        const int    level = level_of(page);
        const bool   needs =
            level > 0 && !all_free(refinement, level, node_at(page, 0), shifted_by(last, tile_edge - page_edge));
        keys[i]  = needs ? tread::mpm::page_key(coarser_page(page, static_cast<int>(i % 8))) : no_page;
        order[i] = 0;
    }
};

struct FindNeighbours
{
    const std::uint64_t* from_key;
    const std::uint64_t* in_key;
    std::int64_t         in_count;
    int                  sign;
    std::int32_t*        found;

    TREAD_HD void operator()(std::int64_t i) const
    {
        const auto key = page_key(page_at_octant(page_coordinates(from_key[i / 8]), static_cast<int>(i % 8), sign));
        found[i]       = static_cast<std::int32_t>(find_sorted(in_key, in_count, key));
    }
};

struct FindAround
{
    const std::uint64_t* page_key;
    std::int64_t         pages;
    std::int32_t*        neighbour;

    TREAD_HD void operator()(std::int64_t i) const
    {
        const Index3 page = page_towards(page_coordinates(page_key[i / directions]), static_cast<int>(i % directions));
        neighbour[i]      = static_cast<std::int32_t>(find_sorted(page_key, pages, tread::mpm::page_key(page)));
    }
};

} // namespace order_steps

/// Reorders a field plane by plane, so that the buffer is only one plane: that of the sort, which is finished.
template<class Exec, class Real, class T>
void gather_field(const Exec& exec, Array<Exec, T>& field, const Points<Exec, Real>& points, int components,
                  const std::int32_t* order, SortScratch<Exec>& scratch)
{
    static_assert(sizeof(T) <= sizeof(*scratch.keys.data()));
    scratch.keys.resize(points.count);
    T* buffer = reinterpret_cast<T*>(scratch.keys.data());
    for (int c = 0; c < components; ++c)
    {
        T* plane = field.data() + c * points.stride;
        for_each(exec, "gather points", points.count, order_steps::Gather<T>{plane, buffer, order});
        copy(exec, plane, buffer, static_cast<std::size_t>(points.count) * sizeof(T));
    }
}

/// Reorders the points: point i becomes the one at order[i].
template<class Exec, class Real>
void gather_points(const Exec& exec, Points<Exec, Real>& points, const std::int32_t* order, SortScratch<Exec>& scratch)
{
    points.for_each_field([&](auto& field, int components)
                          { gather_field(exec, field, points, components, order, scratch); });
}

/// Writes the distinct pages of the sorted keys to `page_key`; the lowest `shift` bits of the keys are ignored.
template<class Exec, class Real>
void write_pages(const Exec& exec, const Array<Exec, std::uint64_t>& keys, int shift,
                 Array<Exec, std::uint64_t>& page_key, OrderScratch<Exec, Real>& scratch)
{
    using namespace order_steps;
    scratch.sort.values.resize(keys.size());
    for_each(exec, "mark pages", keys.size(), MarkFirstOfPage{keys.data(), scratch.sort.values.data(), shift});
    page_key.resize(exclusive_scan(exec, scratch.sort.values, scratch.sort));
    for_each(exec, "write pages", keys.size(),
             WritePages{keys.data(), scratch.sort.values.data(), page_key.data(), shift});
}

/// Builds the point pages with their neighbours and the ranges of pages and cells, from the sorted keys of the points.
template<class Exec, class Real>
void build_point_pages(const Exec& exec, Points<Exec, Real>& points, Pages<Exec>& pages, const GridGeometry& geometry,
                       OrderScratch<Exec, Real>& scratch)
{
    using namespace order_steps;
    write_pages(exec, scratch.keys, 6, pages.point_page_key, scratch);
    const std::int64_t around = directions * pages.point_page_key.size();
    scratch.neighbour_keys.resize(around);
    scratch.neighbour_order.resize(around);
    for_each(exec, "surrounding keys", around,
             SurroundingKeys{pages.point_page_key.data(), scratch.keys.data(), scratch.keys.size(), geometry,
                             scratch.neighbour_keys.data(), scratch.neighbour_order.data()});
    sort_by_key(exec, scratch.neighbour_keys, scratch.neighbour_order, scratch.sort);
    write_pages(exec, scratch.neighbour_keys, 0, pages.point_page_key, scratch);

    const std::int64_t count = pages.point_page_key.size();
    pages.first_point.resize(count + 1);
    for_each(exec, "first points", count + 1,
             FirstOfPage{scratch.keys.data(), scratch.keys.size(), count, pages.point_page_key.data(),
                         pages.first_point.data()});
    points.count = read(exec, pages.first_point.data() + count);
    pages.cell_first_point.resize(count * page_cells + 1);
    for_each(exec, "write cells", count * page_cells + 1,
             FirstOfCell{scratch.keys.data(), points.count, count, pages.point_page_key.data(),
                         pages.first_point.data(), pages.cell_first_point.data()});
    pages.point_at.resize(points.count);
    pages.place_at.resize(points.count);
    for_each(exec, "list points", points.count,
             ListInOrder{scratch.keys.data(), pages.point_at.data(), pages.place_at.data()});
    pages.neighbour.resize(directions * count);
    for_each(exec, "find neighbours", directions * count,
             FindAround{pages.point_page_key.data(), count, pages.neighbour.data()});
}

/// Links each point page to its node pages and vice versa.
template<class Exec>
void link_pages(const Exec& exec, Pages<Exec>& pages)
{
    using namespace order_steps;
    const std::int64_t point_pages = pages.point_page_key.size(), node_pages = pages.node_page_key.size();
    pages.node_page_of.resize(8 * point_pages);
    for_each(exec, "find node pages", 8 * point_pages,
             FindNeighbours{pages.point_page_key.data(), pages.node_page_key.data(), node_pages, 1,
                            pages.node_page_of.data()});
    pages.point_page_of.resize(8 * node_pages);
    for_each(exec, "find point pages", 8 * node_pages,
             FindNeighbours{pages.node_page_key.data(), pages.point_page_key.data(), point_pages, -1,
                            pages.point_page_of.data()});
}

/// Builds the node pages: point pages and their upper neighbours, and the pages of the parents of slave nodes.
template<class Exec, class Real>
void build_node_pages(const Exec& exec, Pages<Exec>& pages, const Refinement& refinement,
                      OrderScratch<Exec, Real>& scratch)
{
    using namespace order_steps;
    const std::int64_t reached = 8 * pages.point_page_key.size(), all = reached * (refinement.levels > 0 ? 2 : 1);
    scratch.neighbour_keys.resize(all);
    scratch.neighbour_order.resize(all);
    for_each(exec, "neighbour keys", reached,
             NeighbourKeys{pages.point_page_key.data(), scratch.neighbour_keys.data(), scratch.neighbour_order.data()});
    if (refinement.levels > 0)
    {
        for_each(exec, "parent keys", reached,
                 ParentKeys{pages.point_page_key.data(), refinement, scratch.neighbour_keys.data() + reached,
                            scratch.neighbour_order.data() + reached});
    }
    sort_by_key(exec, scratch.neighbour_keys, scratch.neighbour_order, scratch.sort);
    write_pages(exec, scratch.neighbour_keys, 0, pages.node_page_key, scratch);
    link_pages(exec, pages);
}

template<class Exec, class Real>
std::int64_t order_points(const Exec& exec, Points<Exec, Real>& points, Pages<Exec>& pages,
                          const GridGeometry& geometry, OrderScratch<Exec, Real>& scratch)
{
    const std::int64_t n = points.count;
    scratch.keys.resize(n);
    scratch.order.resize(n);
    for_each(exec, "point keys", n,
             order_steps::MakeKeys<Real>{points.view(), geometry, scratch.keys.data(), scratch.order.data()});
    sort_by_key(exec, scratch.keys, scratch.order, scratch.sort);
    gather_points(exec, points, scratch.order.data(), scratch.sort);
    build_point_pages(exec, points, pages, geometry, scratch);
    build_node_pages(exec, pages, geometry.refinement, scratch);
    return n - points.count;
}

template<class Exec>
void set_node_pages(const Exec& exec, Pages<Exec>& pages, const std::vector<std::uint64_t>& keys)
{
    pages.node_page_key.assign(keys);
    link_pages(exec, pages);
}

template<class Exec, class Real>
void renew_order(const Exec& exec, Points<Exec, Real>& points, Pages<Exec>& pages, OrderScratch<Exec, Real>& scratch)
{
    gather_points(exec, points, pages.point_at.data(), scratch.sort);
    for_each(exec, "list points", points.count, order_steps::ListAsInMemory{pages.point_at.data()});
}

} // namespace tread::mpm
