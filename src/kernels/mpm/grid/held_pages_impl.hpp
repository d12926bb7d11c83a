#pragma once

#include "backend/instantiate.hpp"
#include "kernels/mpm/grid/held_pages_kern.hpp"

// list_held_pages, for both backends; held_pages.cpp and held_pages.cu provide for_each and instantiate.
namespace tread::mpm
{

/// Finds the sleeping pages, by octant, whose points contribute to a node page.
struct SleepingAround
{
    PagesView            pages;
    const std::uint64_t* asleep;
    std::int64_t         asleep_count;

    TREAD_HD unsigned operator()(std::int64_t node_page) const
    {
        const Index3 at       = page_coordinates(pages.node_page_key[node_page]);
        unsigned     sleeping = 0;
        for (int octant = 0; octant < octants; ++octant)
        {
            const Index3 page{at.x - (octant & 1), at.y - (octant >> 1 & 1), at.z - (octant >> 2)};
            sleeping |= unsigned(find_sorted(asleep, asleep_count, page_key(page)) >= 0) << octant;
        }
        return sleeping;
    }
};

struct MarkHeldPage
{
    SleepingAround around;
    std::int32_t*  marks;

    TREAD_HD void operator()(std::int64_t i) const { marks[i] = around(i) != 0; }
};

/// Writes a held page; after the scan before[i] is the number of held pages before i.
struct WriteHeldPage
{
    SleepingAround      around;
    const std::int32_t* before;
    std::int32_t*       page;
    std::uint8_t*       octants;

    TREAD_HD void operator()(std::int64_t i) const
    {
        const unsigned sleeping = around(i);
        if (sleeping == 0) { return; }
        page[before[i]]    = static_cast<std::int32_t>(i);
        octants[before[i]] = static_cast<std::uint8_t>(sleeping);
    }
};

template<class Exec>
void list_held_pages(const Exec& exec, const PagesView& pages, const Array<Exec, std::uint64_t>& asleep,
                     HeldPages<Exec>& held, SortScratch<Exec>& scratch)
{
    const SleepingAround around{pages, asleep.data(), asleep.size()};
    held.marks.resize(pages.node_pages);
    for_each(exec, "mark held pages", pages.node_pages, MarkHeldPage{around, held.marks.data()});
    const std::int64_t count = exclusive_scan(exec, held.marks, scratch);
    held.page.resize(count);
    held.octants.resize(count);
    held.impulse.resize(3 * count);
    held.impulse.fill_zero();
    for_each(exec, "write held pages", pages.node_pages,
             WriteHeldPage{around, held.marks.data(), held.page.data(), held.octants.data()});
}

template<class Exec>
void keep_largest_speeds(const Exec& exec, std::int64_t pages, const double* peaks, double* largest)
{
    for_each(exec, "keep largest speeds", pages, KeepLargestSpeed{peaks, largest});
}

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template void list_held_pages(const Exec&, const PagesView&, const Array<Exec, std::uint64_t>&, HeldPages<Exec>&,  \
                                  SortScratch<Exec>&);                                                                 \
    template void keep_largest_speeds(const Exec&, std::int64_t, const double*, double*)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::mpm
