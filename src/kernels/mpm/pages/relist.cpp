#include "kernels/mpm/pages/relist.hpp"

#include "backend/instantiate.hpp"
#include "backend/launch.hpp"
#include "kernels/mpm/pages/relist_impl.hpp"

namespace tread::mpm
{
namespace
{

/// Calls visit(place, place in the old list) for every point that is in `page` now.
template<class Visit>
void for_each_listed(const Relisting& job, std::int64_t page, Visit visit)
{
    const auto take = [&](std::int64_t from, int direction)
    {
        for (std::int32_t at = job.old.first_point[from]; at < job.old.first_point[from + 1]; ++at)
        {
            const int move = job.moves.to[at];
            if (move / page_cells == direction) { visit(move % page_cells, at); }
        }
    };
    take(page, own_page);
    for (int d = 0; d < directions; ++d)
    {
        if (arrivals(job.old, job.moves, page, d) > 0)
        {
            take(job.old.neighbour[page * directions + d], directions - 1 - d);
        }
    }
}

void copy_list(const Relisting& job, std::int64_t page)
{
    const std::int32_t from = job.old.first_point[page], to = job.first_point[page];
    for (std::int64_t c = page * page_cells; c < (page + 1) * page_cells; ++c)
    {
        job.cell_first_point[c] = job.old.cell_first_point[c] - from + to;
    }
    const std::int32_t end = job.old.first_point[page + 1];
    std::copy(job.old.point_at + from, job.old.point_at + end, job.point_at + to);
    std::copy(job.old.place_at + from, job.old.place_at + end, job.place_at + to);
}

void relist_page(const Relisting& job, std::int64_t page)
{
    if (unchanged(job.old, job.moves, page))
    {
        copy_list(job, page);
        return;
    }
    std::int32_t next[page_cells] = {};
    for_each_listed(job, page, [&](int place, std::int32_t) { ++next[place]; });
    std::int32_t first = job.first_point[page];
    for (int place = 0; place < page_cells; ++place)
    {
        job.cell_first_point[page * page_cells + place] = first;
        first += std::exchange(next[place], first);
    }
    for_each_listed(job, page,
                    [&](int place, std::int32_t at)
                    {
                        const std::int32_t to = next[place]++;
                        job.point_at[to]      = job.old.point_at[at];
                        job.place_at[to]      = static_cast<std::uint8_t>(place);
                    });
}

} // namespace

template<class Exec>
bool may_have_changed_cells(const Exec&, const MovesView& moves)
{
    return moves.any_changed_cell();
}

template<class Exec>
void start_pages(const Exec& cpu, const PagesView& old, const MovesView& moves, RelistScratch<Exec>& scratch)
{
    for_each(cpu, "count pages", old.point_pages + 1, CountAfter{old, moves, scratch.first_point.data()});
    scan_in_place(cpu, scratch.first_point, scratch.sort);
}

template<class Exec>
void relist_pages(const Exec& cpu, const Relisting& job)
{
    for_each_heavy(cpu, "relist points", job.old.point_pages, [=](std::int64_t page) { relist_page(job, page); });
}

template void relist_points(const Cpu&, Pages<Cpu>&, const MovesView&, RelistScratch<Cpu>&, Array<Cpu, std::uint64_t>&);

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template bool may_have_changed_cells(const Exec&, const MovesView&);                                               \
    template void start_pages(const Exec&, const PagesView&, const MovesView&, RelistScratch<Exec>&);                  \
    template void relist_pages(const Exec&, const Relisting&)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::mpm
