#pragma once

#include "backend/array.hpp"
#include "backend/sort.hpp"
#include "kernels/mpm/pages/pages.hpp"

// Numbering of a subset of the node pages in their order; the including file provides for_each.
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

/// Writes the marked pages; after the scan number_of[i] is the number of marked pages before i.
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

/// Lists the node pages for which is_one(node page) holds, and writes each node page's index in this list, or -1.
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

/// Returns the node page at page coordinates, or -1.
TREAD_HD std::int32_t find_node_page(const PagesView& pages, Index3 page)
{
    return static_cast<std::int32_t>(find_sorted(pages.node_page_key, pages.node_pages, page_key(page)));
}

} // namespace tread::mpm
