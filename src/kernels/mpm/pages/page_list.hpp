#pragma once

#include "kernels/mpm/pages/pages.hpp"

namespace tread::mpm
{

/// List of some of the point pages.
struct PageList
{
    std::int64_t        count;
    const std::int32_t* page; ///< [count], without duplicates; null: consecutive pages starting at `first`
    std::int64_t        first = 0;

    TREAD_HD std::int64_t at(std::int64_t i) const { return page == nullptr ? first + i : page[i]; }
};

inline PageList all_point_pages(const PagesView& pages) { return {pages.point_pages, nullptr}; }

} // namespace tread::mpm
