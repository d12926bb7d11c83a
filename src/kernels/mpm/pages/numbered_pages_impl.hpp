#pragma once

#include "backend/array.hpp"
#include "backend/sort.hpp"
#include "kernels/mpm/pages/pages.hpp"

// Some of the node pages, numbered in their order; who includes this brings in for_each.
namespace tread::mpm
{
namespace numbered_steps
{

template<class IsOne>
struct Mark
{
    IsOne         is_one;
    std::int32_t* marks;

    TREAD_HD void operator()(std::int64_t i) const { marks[i] = is_one(i); }
};

/// After the scan number_of[i] counts the marked pages before i.
template<class IsOne>
struct Write
{
    IsOne         is_one;
    std::int32_t* number_of;
    std::int32_t* page;

    TREAD_HD void operator()(std::int64_t i) const
    {
        if (is_one(i)) { page[number_of[i]] = static_cast<std::int32_t>(i); }
        else { number_of[i] = -1; }
    }
};

} // namespace numbered_steps

/// Writes the node pages of which is_one(node page) holds, and of every node page its number among them, or -1.
template<class Exec, class IsOne>
void number_pages(const Exec& exec, const PagesView& pages, const IsOne& is_one, const char* mark, const char* write,
                  Array<Exec, std::int32_t>& page, Array<Exec, std::int32_t>& number_of, SortScratch<Exec>& scratch)
{
    using namespace numbered_steps;
    number_of.resize(pages.node_pages);
    for_each(exec, mark, pages.node_pages, Mark<IsOne>{is_one, number_of.data()});
    page.resize(exclusive_scan(exec, number_of, scratch));
    for_each(exec, write, pages.node_pages, Write<IsOne>{is_one, number_of.data(), page.data()});
}

/// Node page of page coordinates, or -1.
TREAD_HD std::int32_t find_node_page(const PagesView& pages, Index3 page)
{
    return static_cast<std::int32_t>(find_sorted(pages.node_page_key, pages.node_pages, page_key(page)));
}

} // namespace tread::mpm
