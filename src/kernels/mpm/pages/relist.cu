#include <cub/block/block_scan.cuh>

#include "backend/instantiate.hpp"
#include "backend/launch.cuh"
#include "backend/warp.cuh"
#include "kernels/mpm/pages/relist_impl.hpp"

namespace tread::mpm
{
namespace
{

constexpr int relist_warps = 4;

/// Relists one page per warp: places are counted, then filled in the order of the old list, 32 points at a time.
struct RelistPages
{
    Relisting job;

    __device__ void operator()(std::int64_t block) const
    {
        __shared__ std::int32_t next[relist_warps][page_cells];
        const int               warp = static_cast<int>(threadIdx.x) / 32;
        const std::int64_t      page = block * relist_warps + warp;
        if (page >= job.old.point_pages || !job.moves.any_changed_cell()) { return; }
        const bool     arrive  = lane() < directions && arrivals(job.old, job.moves, page, lane()) > 0;
        const unsigned sources = __ballot_sync(all_lanes, arrive);
        if (sources == 0 && job.moves.count[page * move_counts + changed_points] == 0) { copy_list(page); }
        else { relist(page, sources, next[warp]); }
    }

private:
    __device__ static int lane() { return static_cast<int>(threadIdx.x) % 32; }

    __device__ void copy_list(std::int64_t page) const
    {
        const std::int32_t from = job.old.first_point[page], to = job.first_point[page];
        for (std::int64_t c = page * page_cells + lane(); c < (page + 1) * page_cells; c += 32)
        {
            job.cell_first_point[c] = job.old.cell_first_point[c] - from + to;
        }
        for (std::int32_t at = from + lane(); at < job.old.first_point[page + 1]; at += 32)
        {
            job.point_at[to + at - from] = job.old.point_at[at];
            job.place_at[to + at - from] = job.old.place_at[at];
        }
    }

    /// Relists a page; `sources`: a bit for each direction from which points arrive.
    __device__ void relist(std::int64_t page, unsigned sources, std::int32_t* next) const
    {
        next[lane()] = next[lane() + 32] = 0;
        __syncwarp();
        for_each_listed(page, sources,
                        [&](bool listed, int place, std::int32_t)
                        {
                            if (listed) { atomicAdd(next + place, 1); }
                        });
        __syncwarp();
        start_cells(page, next);
        for_each_listed(page, sources, [&](bool listed, int place, std::int32_t at) { put(listed, place, at, next); });
    }

    /// Calls visit(listed, place, place in the old list) with all lanes together; `listed` = the point is in `page`
    /// now.
    template<class Visit>
    __device__ void for_each_listed(std::int64_t page, unsigned sources, Visit visit) const
    {
        take(page, own_page, visit);
        for (; sources != 0; sources &= sources - 1)
        {
            const int d = __ffs(static_cast<int>(sources)) - 1;
            take(job.old.neighbour[page * directions + d], directions - 1 - d, visit);
        }
    }

    template<class Visit>
    __device__ void take(std::int64_t from, int direction, Visit visit) const
    {
        const std::int32_t end = job.old.first_point[from + 1];
        for (std::int32_t first = job.old.first_point[from]; first < end; first += 32)
        {
            const std::int32_t at   = first + lane();
            const int          move = at < end ? job.moves.to[at] : 0;
            visit(at < end && move / page_cells == direction, move % page_cells, at);
        }
    }

    /// Converts counts to first places, two per lane.
    __device__ void start_cells(std::int64_t page, std::int32_t* next) const
    {
        const std::int32_t low = next[2 * lane()], high = next[2 * lane() + 1];
        std::int32_t       sum = low + high;
        for (int step = 1; step < 32; step *= 2)
        {
            const std::int32_t before = __shfl_up_sync(all_lanes, sum, step);
            if (lane() >= step) { sum += before; }
        }
        const std::int32_t start = job.first_point[page] + sum - low - high;
        __syncwarp();
        next[2 * lane()]                                         = start;
        next[2 * lane() + 1]                                     = start + low;
        job.cell_first_point[page * page_cells + 2 * lane()]     = start;
        job.cell_first_point[page * page_cells + 2 * lane() + 1] = start + low;
        __syncwarp();
    }

    /// Writes the points; lanes with the same place are ordered by lane.
    __device__ void put(bool listed, int place, std::int32_t at, std::int32_t* next) const
    {
        const unsigned lanes = __match_any_sync(all_lanes, listed ? place : page_cells);
        if (listed)
        {
            const std::int32_t to = next[place] + __popc(lanes & ((1u << lane()) - 1));
            job.point_at[to]      = job.old.point_at[at];
            job.place_at[to]      = static_cast<std::uint8_t>(place);
        }
        __syncwarp();
        if (listed && lane() == __ffs(static_cast<int>(lanes)) - 1) { next[place] += __popc(lanes); }
        __syncwarp();
    }
};

constexpr int start_threads = 1024;

/// Number of pages that one block counts and scans in less time than three launches.
constexpr std::int64_t few_pages = 8 * start_threads;

struct StartFewPages
{
    PagesView     pages;
    MovesView     moves;
    std::int32_t* first_point;

    __device__ void operator()(std::int64_t) const
    {
        using Scan = cub::BlockScan<std::int32_t, start_threads>;
        __shared__ typename Scan::TempStorage storage;
        if (!moves.any_changed_cell()) { return; }
        std::int32_t before = 0;
        for (std::int64_t first = 0; first <= pages.point_pages; first += start_threads)
        {
            const std::int64_t page  = first + threadIdx.x;
            std::int32_t       start = page < pages.point_pages ? count_after(pages, moves, page) : 0, all = 0;
            Scan(storage).ExclusiveSum(start, start, all);
            if (page <= pages.point_pages) { first_point[page] = before + start; }
            before += all;
            __syncthreads();
        }
    }
};

} // namespace

template<class Exec>
void start_pages(const Exec& gpu, const PagesView& old, const MovesView& moves, RelistScratch<Exec>& scratch)
{
    std::int32_t* first_point = scratch.first_point.data();
    if (old.point_pages <= few_pages)
    {
        for_each_block<start_threads>(gpu, "start pages", 1, StartFewPages{old, moves, first_point});
        return;
    }
    for_each(gpu, "count pages", old.point_pages + 1, CountAfter{old, moves, first_point});
    scan_in_place(gpu, scratch.first_point, scratch.sort);
}

template<class Exec>
bool may_have_changed_cells(const Exec&, const MovesView&)
{
    return true;
}

template<class Exec>
void relist_pages(const Exec& gpu, const Relisting& job)
{
    for_each_block<32 * relist_warps>(gpu, "relist points", (job.old.point_pages + relist_warps - 1) / relist_warps,
                                      RelistPages{job});
}

template void relist_points(const Gpu&, Pages<Gpu>&, const MovesView&, RelistScratch<Gpu>&, Array<Gpu, std::uint64_t>&);

#define TREAD_INSTANTIATE(Exec)                                                                                        \
    template bool may_have_changed_cells(const Exec&, const MovesView&);                                               \
    template void start_pages(const Exec&, const PagesView&, const MovesView&, RelistScratch<Exec>&);                  \
    template void relist_pages(const Exec&, const Relisting&)
TREAD_FOR_THIS_BACKEND(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::mpm
