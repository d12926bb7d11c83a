#include "solver/sand/page_watch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "backend/instantiate.hpp"
#include "decomp/messages.hpp"
#include "solver/state_file.hpp"

namespace tread::solver
{

template<class Exec>
PageWatch<Exec>::PageWatch(const Exec& exec)
    : exec_(exec)
    , speeds_(exec, "largest speeds of pages")
{
}

template<class Exec>
void PageWatch<Exec>::pass(double dt)
{
    window_ += dt;
    uncollected_ += dt;
}

template<class Exec>
void PageWatch<Exec>::note(const double* peaks)
{
    mpm::keep_largest_speeds(exec_, speeds_.size(), peaks, speeds_.data());
}

template<class Exec>
void PageWatch<Exec>::collect(mpm::HeldPages<Exec>& held)
{
    const std::vector<double> speeds = speeds_.to_host(), impulse = held.impulse.to_host();
    for (std::size_t i = 0; i < speeds.size(); ++i)
    {
        if (speeds[i] == 0) { continue; }
        Rest& page         = rest_[keys_[i]];
        page.speed_squared = std::max(page.speed_squared, speeds[i]);
    }
    for (std::size_t i = 0; i < held_keys_.size(); ++i)
    {
        Load& load = held_[held_keys_[i]].load;
        load.impulse += Vec3<double>(impulse.data() + 3 * i);
        load.time += uncollected_;
    }
    speeds_.fill_zero();
    held.impulse.fill_zero();
    uncollected_ = 0;
}

template<class Exec>
void PageWatch<Exec>::follow(const mpm::Pages<Exec>& pages, const mpm::HeldPages<Exec>& held)
{
    keys_ = pages.point_page_key.to_host();
    speeds_.resize(pages.point_page_key.size());
    speeds_.fill_zero();

    const std::vector<std::uint64_t> node_page = pages.node_page_key.to_host();
    const std::vector<std::int32_t>  page      = held.page.to_host();
    const std::vector<std::uint8_t>  octants   = held.octants.to_host();
    const auto                       before    = std::exchange(held_, {});
    held_keys_.clear();
    for (std::size_t i = 0; i < page.size(); ++i)
    {
        const std::uint64_t key = node_page[static_cast<std::size_t>(page[i])];
        const auto          was = before.find(key);
        held_keys_.push_back(key);
        held_[key] = was != before.end() && was->second.octants == octants[i] ? was->second : Held{octants[i], Load{}};
    }
}

template<class Exec>
std::vector<AwakePage> PageWatch<Exec>::awake(const mpm::Pages<Exec>& pages, double speed) const
{
    const std::vector<std::int32_t> first = pages.first_point.to_host();
    std::vector<AwakePage>          awake;
    for (std::size_t i = 0; i < keys_.size(); ++i)
    {
        if (first[i] == first[i + 1]) { continue; }
        const auto   known   = rest_.find(keys_[i]);
        const double largest = known == rest_.end() ? 0 : std::sqrt(known->second.speed_squared);
        const double quiet =
            known == rest_.end() || largest > speed ? 0 : known->second.quiet + window_ - known->second.late;
        awake.push_back({keys_[i], largest, quiet});
    }
    return awake;
}

template<class Exec>
void PageWatch<Exec>::remember(const std::vector<AwakePage>& awake)
{
    rest_.clear();
    for (const AwakePage& page : awake) { rest_.emplace_hint(rest_.end(), page.key, Rest{0, page.quiet, 0}); }
}

template<class Exec>
void PageWatch<Exec>::tell_ranks(const Communicator& communicator)
{
    struct PageSpeed
    {
        std::uint64_t key;
        double        squared;
    };
    std::vector<PageSpeed> own;
    for (const auto& [key, page] : rest_)
    {
        if (page.speed_squared > 0) { own.push_back({key, page.speed_squared}); }
    }
    for (const auto& of_rank : decomp::gather_values(communicator, own))
    {
        for (const PageSpeed& page : of_rank)
        {
            double& largest = rest_[page.key].speed_squared;
            largest         = std::max(largest, page.squared);
        }
    }
}

template<class Exec>
void PageWatch<Exec>::note_woken(const std::vector<std::uint64_t>& pages)
{
    for (const std::uint64_t key : pages) { rest_[key] = {0, 0, window_}; }
}

template<class Exec>
std::vector<std::uint64_t> PageWatch<Exec>::pressed(double force)
{
    std::vector<std::uint64_t> pages;
    for (auto& [key, held] : held_)
    {
        Load& load = held.load;
        if (load.time == 0) { continue; }
        const Vec3<double> mean = load.impulse / load.time;
        if (load.windows == 0) { load.first = mean; }
        else if ((mean - load.first).norm() > force)
        {
            const mpm::Index3 at = mpm::page_coordinates(key);
            for (int octant = 0; octant < mpm::octants; ++octant)
            {
                if ((held.octants >> octant & 1) == 0) { continue; }
                pages.push_back(mpm::page_key({at.x - (octant & 1), at.y - (octant >> 1 & 1), at.z - (octant >> 2)}));
            }
        }
        load = {load.windows + 1, load.first, Vec3<double>::Zero(), 0};
    }
    std::sort(pages.begin(), pages.end());
    pages.erase(std::unique(pages.begin(), pages.end()), pages.end());
    return pages;
}

/// Before loading, follow() must have been called with the saved pages.
template<class Exec>
void PageWatch<Exec>::transfer(StateFile& file, mpm::HeldPages<Exec>& held)
{
    std::vector<std::uint64_t> rest_key, held_key;
    std::vector<Rest>          rest;
    std::vector<Load>          load;
    for (const auto& [key, page] : rest_)
    {
        rest_key.push_back(key);
        rest.push_back(page);
    }
    for (const auto& [key, page] : held_)
    {
        held_key.push_back(key);
        load.push_back(page.load);
    }
    const auto held_pages = static_cast<std::size_t>(held.impulse.size());
    file.own("sleep/rest_page", rest_key, accept::all(accept::ascending(), accept::distinct()));
    file.own("sleep/rest", rest, accept::all(accept::rows(rest_key.size()), accept::not_negative()));
    file.own("sleep/held_page", held_key, accept::same_as(held_key)); // the followed pages are determined by the pages
    file.own("sleep/load", load, accept::all(accept::rows(held_key.size()), accept::finite()));
    file.own("sleep/speeds", speeds_, accept::all(accept::rows(keys_.size()), accept::not_negative()));
    file.own("sleep/impulse", held.impulse, accept::all(accept::rows(held_pages), accept::finite()));
    file.numbers("sleep/watch", window_, uncollected_);
    if (!file.loads()) { return; }
    rest_.clear();
    for (std::size_t i = 0; i < rest.size(); ++i) { rest_.emplace(rest_key[i], rest[i]); }
    for (std::size_t i = 0; i < load.size(); ++i) { held_.at(held_key[i]).load = load[i]; }
}

#define TREAD_INSTANTIATE(Exec) template class PageWatch<Exec>
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::solver
