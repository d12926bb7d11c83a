#include "solver/sand/page_rest.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "kernels/mpm/pages/page_key.hpp"

namespace tread::solver
{
namespace
{

/// Share of the awake pages: fewer do not fall asleep by themselves, since all points are then sorted.
constexpr double worth_a_sort = 1.0 / 16;

using Index = std::array<std::int32_t, 3>;

Index index_of(std::uint64_t key)
{
    const mpm::Index3 page = mpm::page_coordinates(key);
    return {page.x, page.y, page.z};
}

/// Marks on the pages of a box.
class PageMarks
{
public:
    /// From page `low` to page `high`, both included.
    PageMarks(const Index& low, const Index& high)
        : low_(low)
    {
        for (std::size_t c = 0; c < 3; ++c) { size_[c] = high[c] - low[c] + 1; }
        marks_.resize(static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]) *
                      static_cast<std::size_t>(size_[2]));
    }

    bool at(std::uint64_t key) const { return marks_[place(index_of(key))] != 0; }
    void mark(const Index& page) { marks_[place(page)] = 1; }

    /// Marks the pages of edge `edge` (m) that are nearer to a place (m) than `reach` (m).
    void mark_ball(const Vec3<double>& centre, double reach, double edge)
    {
        Index first, last;
        for (std::size_t c = 0; c < 3; ++c)
        {
            const double at = centre[static_cast<Eigen::Index>(c)];
            first[c]        = std::max(static_cast<std::int32_t>(std::floor((at - reach) / edge)), low_[c]);
            last[c] = std::min(static_cast<std::int32_t>(std::floor((at + reach) / edge)), low_[c] + size_[c] - 1);
            squares_[c].clear();
            for (std::int32_t page = first[c]; page <= last[c]; ++page)
            {
                const double off = at - std::clamp(at, page * edge, (page + 1) * edge);
                squares_[c].push_back(off * off);
            }
        }
        const double within   = reach * reach;
        const auto& [x, y, z] = squares_;
        if (x.empty()) { return; }
        for (std::size_t k = 0; k < z.size(); ++k)
        {
            for (std::size_t j = 0; j < y.size(); ++j)
            {
                if (!(y[j] + z[k] < within)) { continue; }
                std::uint8_t* row = marks_.data() + place({first[0], first[1] + static_cast<std::int32_t>(j),
                                                           first[2] + static_cast<std::int32_t>(k)});
                for (std::size_t i = 0; i < x.size(); ++i)
                {
                    row[i] = static_cast<std::uint8_t>(row[i] | (x[i] + y[j] + z[k] < within ? 1 : 0));
                }
            }
        }
    }

    /// Marks all pages within `ring` of a marked one along every axis.
    void widen(int ring)
    {
        std::size_t stride = 1;
        for (const std::int32_t length : size_)
        {
            widen_along(static_cast<std::size_t>(length), stride, ring);
            stride *= static_cast<std::size_t>(length);
        }
    }

private:
    std::size_t place(const Index& page) const
    {
        std::size_t at = 0, stride = 1;
        for (std::size_t c = 0; c < 3; ++c)
        {
            at += stride * static_cast<std::size_t>(page[c] - low_[c]);
            stride *= static_cast<std::size_t>(size_[c]);
        }
        return at;
    }

    /// Widens along one axis: forwards, then backwards, counting pages since the last mark.
    void widen_along(std::size_t length, std::size_t stride, int ring)
    {
        const std::vector<std::uint8_t> before = marks_;
        for (std::size_t first = 0; first < marks_.size(); ++first)
        {
            if (first / stride % length != 0) { continue; }
            for (const bool forwards : {true, false})
            {
                int since = ring + 1;
                for (std::size_t i = 0; i < length; ++i)
                {
                    const std::size_t at = first + stride * (forwards ? i : length - 1 - i);
                    since                = before[at] != 0 ? 0 : std::min(since + 1, ring + 1);
                    if (since <= ring) { marks_[at] = 1; }
                }
            }
        }
    }

    Index                              low_;
    Index                              size_{};
    std::vector<std::uint8_t>          marks_;
    std::array<std::vector<double>, 3> squares_; ///< m2, scratch of mark_ball(): offsets of pages along each axis
};

PageMarks around_all(const RestState& state)
{
    Index      low{0, 0, 0}, high{0, 0, 0};
    bool       any     = false;
    const auto include = [&](std::uint64_t key)
    {
        const Index page = index_of(key);
        for (std::size_t c = 0; c < 3; ++c)
        {
            low[c]  = any ? std::min(low[c], page[c]) : page[c];
            high[c] = any ? std::max(high[c], page[c]) : page[c];
        }
        any = true;
    };
    for (const AwakePage& page : state.awake) { include(page.key); }
    for (const std::uint64_t key : state.asleep) { include(key); }
    return {low, high};
}

/// Marks the pages that are nearer to a body than a distance of it (m).
void mark_near(const std::vector<BodyReach>& bodies, double edge, double BodyReach::*distance, PageMarks& marks)
{
    for (const BodyReach& body : bodies) { marks.mark_ball(body.centre, body.*distance, edge); }
}

bool any_at(const PageMarks& marks, const std::vector<std::uint64_t>& pages)
{
    return std::any_of(pages.begin(), pages.end(), [&](std::uint64_t key) { return marks.at(key); });
}

} // namespace

std::vector<std::uint64_t> choose_asleep(const RestRule& rule, const RestState& state)
{
    const auto rests = [&](const AwakePage& page) { return page.quiet >= rule.rest; };
    if (state.asleep.empty() && std::none_of(state.awake.begin(), state.awake.end(), rests)) { return {}; }
    PageMarks wakes = around_all(state), stays = wakes, moved = wakes;
    for (const std::uint64_t key : state.pressed) { wakes.mark(index_of(key)); }
    wakes.widen(1);
    for (const AwakePage& page : state.awake)
    {
        if (page.speed > rule.speed) { moved.mark(index_of(page.key)); }
        if (!rests(page)) { stays.mark(index_of(page.key)); }
    }
    moved.widen(moving_ring);
    stays.widen(moving_ring + 1);
    if (!state.asleep.empty()) { mark_near(state.bodies, rule.page_edge, &BodyReach::wakes, wakes); }
    PageMarks near = wakes;
    mark_near(state.bodies, rule.page_edge, &BodyReach::rests, near);

    const bool                 any_wakes = any_at(wakes, state.asleep);
    std::vector<std::uint64_t> asleep, tired;
    for (const std::uint64_t key : state.asleep)
    {
        if (!moved.at(key) && !(any_wakes ? near : wakes).at(key)) { asleep.push_back(key); }
    }
    for (const AwakePage& page : state.awake)
    {
        if (rests(page) && !stays.at(page.key) && !near.at(page.key)) { tired.push_back(page.key); }
    }
    const bool sorts = asleep.size() < state.asleep.size();
    if (sorts || static_cast<double>(tired.size()) >= worth_a_sort * static_cast<double>(state.awake.size()))
    {
        asleep.insert(asleep.end(), tired.begin(), tired.end());
    }
    std::sort(asleep.begin(), asleep.end());
    asleep.erase(std::unique(asleep.begin(), asleep.end()), asleep.end()); // points may have entered a sleeping page
    return asleep;
}

std::vector<std::uint64_t> stay_asleep(const RestRule& rule, const std::vector<std::uint64_t>& asleep,
                                       const std::vector<BodyReach>& bodies)
{
    PageMarks near = around_all({{}, asleep, {}, {}});
    mark_near(bodies, rule.page_edge, &BodyReach::wakes, near);
    if (!any_at(near, asleep)) { return asleep; }
    mark_near(bodies, rule.page_edge, &BodyReach::rests, near);
    std::vector<std::uint64_t> stay;
    std::copy_if(asleep.begin(), asleep.end(), std::back_inserter(stay),
                 [&](std::uint64_t key) { return !near.at(key); });
    return stay;
}

} // namespace tread::solver
