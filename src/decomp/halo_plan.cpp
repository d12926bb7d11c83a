#include "decomp/halo_plan.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>

#include "kernels/mpm/pages/page_key.hpp"

namespace tread::decomp
{
namespace
{

bool contains(const PageKeys& keys, std::uint64_t page) { return std::binary_search(keys.begin(), keys.end(), page); }

std::int32_t number_of(const PageKeys& keys, std::uint64_t page)
{
    return static_cast<std::int32_t>(std::lower_bound(keys.begin(), keys.end(), page) - keys.begin());
}

template<class Visit>
void for_each_beside(std::uint64_t page, Visit visit)
{
    const mpm::Index3 at = mpm::page_coordinates(page);
    for (std::int32_t z = -1; z <= 1; ++z)
    {
        for (std::int32_t y = -1; y <= 1; ++y)
        {
            for (std::int32_t x = -1; x <= 1; ++x) { visit(mpm::page_key({at.x + x, at.y + y, at.z + z})); }
        }
    }
}

/// Pages of `theirs`, not in `mine`, that walls tie to pages of `mine`.
PageKeys held_with(const PageKeys& mine, const PageKeys& theirs, const IsHeld& is_held)
{
    PageKeys found;
    for (const std::uint64_t page : theirs)
    {
        if (contains(mine, page) || !is_held(page)) { continue; }
        bool beside = false;
        for_each_beside(page,
                        [&](std::uint64_t other) { beside = beside || (contains(mine, other) && is_held(other)); });
        if (beside) { found.push_back(page); }
    }
    return found;
}

PageKeys common(const PageKeys& a, const PageKeys& b)
{
    PageKeys both;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
    return both;
}

PageKeys united(const PageKeys& a, const PageKeys& b)
{
    PageKeys all;
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all));
    return all;
}

/// Pages that a rank reaching `from` sends to a rank reaching `to`.
PageKeys sent(const PageKeys& from, const PageKeys& to, const IsHeld& is_held)
{
    return united(common(from, to), held_with(to, from, is_held));
}

/// Lists the contributions to every shared page, and which rank accounts for it.
void list_parts(int rank, const std::vector<PageKeys>& reached, const std::vector<PageKeys>& incoming, HaloPlan& plan)
{
    plan.first_part = {0};
    for (std::size_t number = 0; number < plan.shared.size(); ++number)
    {
        const std::uint64_t page   = plan.shared[number];
        std::int64_t        before = 0;
        int                 lowest = -1;
        for (std::size_t other = 0; other < reached.size(); ++other)
        {
            const bool own   = static_cast<int>(other) == rank;
            const bool comes = own ? contains(reached[other], page) : contains(incoming[other], page);
            if (comes)
            {
                const auto arrival = static_cast<std::int32_t>(before + number_of(incoming[other], page));
                plan.part.push_back(own ? -1 : arrival);
                lowest = lowest < 0 ? static_cast<int>(other) : lowest;
            }
            before += static_cast<std::int64_t>(incoming[other].size());
        }
        plan.first_part.push_back(static_cast<std::int32_t>(plan.part.size()));
        if (lowest != rank) { plan.tallied_elsewhere.push_back(static_cast<std::int32_t>(number)); }
    }
}

struct Box
{
    std::array<std::int32_t, 3> low, high;
};

/// Box around the pages, widened by one page; empty if there are none.
Box box_around(const PageKeys& keys)
{
    constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max();
    Box                    box{{most, most, most}, {-most, -most, -most}};
    for (const std::uint64_t page : keys)
    {
        const mpm::Index3                 at = mpm::page_coordinates(page);
        const std::array<std::int32_t, 3> c{at.x, at.y, at.z};
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            box.low[axis]  = std::min(box.low[axis], c[axis] - 1);
            box.high[axis] = std::max(box.high[axis], c[axis] + 1);
        }
    }
    return box;
}

bool inside(const Box& box, std::uint64_t page)
{
    const mpm::Index3 at = mpm::page_coordinates(page);
    return at.x >= box.low[0] && at.x <= box.high[0] && at.y >= box.low[1] && at.y <= box.high[1] &&
           at.z >= box.low[2] && at.z <= box.high[2];
}

std::vector<Box> gather_boxes(const Communicator& communicator, const Box& own)
{
    const std::vector<std::int32_t> all = communicator.gather(
        std::vector<std::int32_t>{own.low[0], own.low[1], own.low[2], own.high[0], own.high[1], own.high[2]});
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < all.size(); i += 6)
    {
        boxes.push_back({{all[i], all[i + 1], all[i + 2]}, {all[i + 3], all[i + 4], all[i + 5]}});
    }
    return boxes;
}

} // namespace

HaloPlan plan_halo(int rank, const std::vector<PageKeys>& reached, const IsHeld& is_held)
{
    const auto            self = static_cast<std::size_t>(rank);
    const PageKeys&       own  = reached[self];
    HaloPlan              plan;
    std::vector<PageKeys> outgoing(reached.size()), incoming(reached.size());
    for (std::size_t other = 0; other < reached.size(); ++other)
    {
        if (other == self) { continue; }
        outgoing[other] = sent(own, reached[other], is_held);
        incoming[other] = sent(reached[other], own, is_held);
        plan.extra      = united(plan.extra, held_with(own, reached[other], is_held));
        plan.shared     = united(plan.shared, united(outgoing[other], incoming[other]));
    }
    for (std::size_t other = 0; other < reached.size(); ++other)
    {
        plan.arrivals.push_back(static_cast<std::int64_t>(incoming[other].size()));
        plan.send.emplace_back();
        for (const std::uint64_t page : outgoing[other]) { plan.send.back().push_back(number_of(plan.shared, page)); }
    }
    list_parts(rank, reached, incoming, plan);
    return plan;
}

std::vector<PageKeys> pages_nearby(const Communicator& communicator, const PageKeys& own)
{
    const std::vector<Box> boxes = gather_boxes(communicator, box_around(own));
    const int              self  = communicator.rank();
    std::vector<PageKeys>  out(boxes.size());
    for (std::size_t other = 0; other < boxes.size(); ++other)
    {
        if (static_cast<int>(other) == self) { continue; }
        std::copy_if(own.begin(), own.end(), std::back_inserter(out[other]),
                     [&](std::uint64_t page) { return inside(boxes[other], page); });
    }
    std::vector<PageKeys> near           = communicator.all_to_all(out);
    near[static_cast<std::size_t>(self)] = own;
    return near;
}

} // namespace tread::decomp
