#pragma once

#include "kernels/mpm/order.hpp"

// The steps of order_points, the same on both backends; order.cpp and order.cu bring in for_each and instantiate.
namespace tread::mpm
{
namespace order_steps
{

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
        const double       margin = 2 * geometry.spacing;
        bool               inside = true;
        for (int c = 0; c < 3; ++c)
        {
            inside = inside && x[c] >= -margin && (c == 2 || x[c] <= geometry.size[c] + margin);
        }
        keys[i]  = inside ? cell_key(cell_of(x, geometry.spacing, geometry.stencil_shift)) : no_page;
        order[i] = static_cast<std::int32_t>(i);
    }
};

template<class T>
struct Gather
{
    const T*            from;
    T*                  to;
    const std::int32_t* order;
    std::int64_t        stride;
    int                 components;

    TREAD_HD void operator()(std::int64_t i) const
    {
        for (int c = 0; c < components; ++c) { to[c * stride + i] = from[c * stride + order[i]]; }
    }
};

struct MarkFirstOfPage
{
    const std::uint64_t* keys;
    std::int32_t*        marks;
    int                  shift; ///< bits of the key below the page

    TREAD_HD void operator()(std::int64_t i) const
    {
        marks[i] = keys[i] != no_page && (i == 0 || keys[i] >> shift != keys[i - 1] >> shift);
    }
};

/// After the scan marks[i] counts the heads before i: a head writes its page.
struct WritePages
{
    const std::uint64_t* keys;
    const std::int32_t*  heads_before;
    std::uint64_t*       page_key;
    std::int32_t*        first;
    int                  shift;

    TREAD_HD void operator()(std::int64_t i) const
    {
        if (keys[i] == no_page || (i > 0 && keys[i] >> shift == keys[i - 1] >> shift)) { return; }
        page_key[heads_before[i]] = keys[i] >> shift;
        if (first != nullptr) { first[heads_before[i]] = static_cast<std::int32_t>(i); }
    }
};

/// Points that left the domain carry the largest key: they stand last, and the last page ends before them.
struct CloseRanges
{
    const std::uint64_t* keys;
    std::int64_t         points;
    std::int32_t*        end;

    TREAD_HD void operator()(std::int64_t) const
    {
        *end = static_cast<std::int32_t>(lower_bound(keys, points, no_page));
    }
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

TREAD_HD Index3 shifted(Index3 page, int octant, int sign)
{
    return {page.x + sign * (octant & 1), page.y + sign * (octant >> 1 & 1), page.z + sign * (octant >> 2)};
}

struct NeighbourKeys
{
    const std::uint64_t* page_key;
    std::uint64_t*       keys;
    std::int32_t*        order;

    TREAD_HD void operator()(std::int64_t i) const
    {
        keys[i]  = tread::mpm::page_key(shifted(page_coordinates(page_key[i / 8]), static_cast<int>(i % 8), 1));
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
        const auto key = page_key(shifted(page_coordinates(from_key[i / 8]), static_cast<int>(i % 8), sign));
        found[i]       = static_cast<std::int32_t>(find_sorted(in_key, in_count, key));
    }
};

} // namespace order_steps

template<class Exec, class Real, class T>
void gather_field(const Exec& exec, Array<Exec, T>& field, Array<Exec, T>& buffer, const Points<Exec, Real>& points,
                  int components, const std::int32_t* order)
{
    buffer.resize(components * points.stride);
    for_each(exec, "gather points", points.count,
             order_steps::Gather<T>{field.data(), buffer.data(), order, points.stride, components});
    copy(exec, field.data(), buffer.data(), static_cast<std::size_t>(components * points.stride) * sizeof(T));
}

template<class Exec, class Real>
void gather_points(const Exec& exec, Points<Exec, Real>& points, OrderScratch<Exec, Real>& scratch)
{
    const auto gather = [&](auto& field, int components)
    {
        using T = std::remove_reference_t<decltype(*field.data())>;
        if constexpr (std::is_same_v<T, Real>)
        {
            gather_field(exec, field, scratch.real, points, components, scratch.order.data());
        }
        else if constexpr (std::is_same_v<T, double>)
        {
            gather_field(exec, field, scratch.wide, points, components, scratch.order.data());
        }
        else if constexpr (std::is_same_v<T, std::uint32_t>)
        {
            gather_field(exec, field, scratch.word, points, components, scratch.order.data());
        }
        else { gather_field(exec, field, scratch.byte, points, components, scratch.order.data()); }
    };
    points.for_each_field(gather);
}

/// Point pages, their point ranges and cell ranges, from the sorted keys.
template<class Exec, class Real>
void build_point_pages(const Exec& exec, Points<Exec, Real>& points, Pages<Exec>& pages,
                       OrderScratch<Exec, Real>& scratch)
{
    using namespace order_steps;
    const std::int64_t n = points.count;
    scratch.marks.resize(n);
    for_each(exec, "mark pages", n, MarkFirstOfPage{scratch.keys.data(), scratch.marks.data(), 6});
    const std::int64_t count = exclusive_scan(exec, scratch.marks, scratch.sort);
    pages.point_page_key.resize(count);
    pages.first_point.resize(count + 1);
    for_each(exec, "write pages", n,
             WritePages{scratch.keys.data(), scratch.marks.data(), pages.point_page_key.data(),
                        pages.first_point.data(), 6});
    for_each(exec, "close pages", 1, CloseRanges{scratch.keys.data(), n, pages.first_point.data() + count});
    points.count = read(exec, pages.first_point.data() + count);
    pages.cell_first_point.resize(count * page_cells + 1);
    for_each(exec, "write cells", count * page_cells + 1,
             FirstOfCell{scratch.keys.data(), points.count, count, pages.point_page_key.data(),
                         pages.first_point.data(), pages.cell_first_point.data()});
}

/// Node pages = point pages and their upper neighbours; tables both ways.
template<class Exec, class Real>
void build_node_pages(const Exec& exec, Pages<Exec>& pages, OrderScratch<Exec, Real>& scratch)
{
    using namespace order_steps;
    const std::int64_t point_pages = pages.point_page_key.size();
    scratch.neighbour_keys.resize(8 * point_pages);
    scratch.neighbour_order.resize(8 * point_pages);
    for_each(exec, "neighbour keys", 8 * point_pages,
             NeighbourKeys{pages.point_page_key.data(), scratch.neighbour_keys.data(), scratch.neighbour_order.data()});
    sort_by_key(exec, scratch.neighbour_keys, scratch.neighbour_order, scratch.sort);
    scratch.marks.resize(8 * point_pages);
    for_each(exec, "mark node pages", 8 * point_pages,
             MarkFirstOfPage{scratch.neighbour_keys.data(), scratch.marks.data(), 0});
    const std::int64_t node_pages = exclusive_scan(exec, scratch.marks, scratch.sort);
    pages.node_page_key.resize(node_pages);
    for_each(exec, "write node pages", 8 * point_pages,
             WritePages{scratch.neighbour_keys.data(), scratch.marks.data(), pages.node_page_key.data(), nullptr, 0});
    pages.node_page_of.resize(8 * point_pages);
    for_each(exec, "find node pages", 8 * point_pages,
             FindNeighbours{pages.point_page_key.data(), pages.node_page_key.data(), node_pages, 1,
                            pages.node_page_of.data()});
    pages.point_page_of.resize(8 * node_pages);
    for_each(exec, "find point pages", 8 * node_pages,
             FindNeighbours{pages.node_page_key.data(), pages.point_page_key.data(), point_pages, -1,
                            pages.point_page_of.data()});
}

template<class Exec, class Real>
void order_points(const Exec& exec, Points<Exec, Real>& points, Pages<Exec>& pages, const GridGeometry& geometry,
                  OrderScratch<Exec, Real>& scratch)
{
    const std::int64_t n = points.count;
    scratch.keys.resize(n);
    scratch.order.resize(n);
    for_each(exec, "point keys", n,
             order_steps::MakeKeys<Real>{points.view(), geometry, scratch.keys.data(), scratch.order.data()});
    sort_by_key(exec, scratch.keys, scratch.order, scratch.sort);
    gather_points(exec, points, scratch);
    build_point_pages(exec, points, pages, scratch);
    build_node_pages(exec, pages, scratch);
}

} // namespace tread::mpm
