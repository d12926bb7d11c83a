#pragma once

#include "kernels/mpm/pages/pages.hpp"

namespace tread::mpm
{

/// Some of the point pages.
struct PageList
{
    std::int64_t        count;
    const std::int32_t* page; ///< [count], each once; null: those from `first` on, in their order
    std::int64_t        first = 0;

    TREAD_HD std::int64_t at(std::int64_t i) const { return page == nullptr ? first + i : page[i]; }
};

inline PageList all_point_pages(const PagesView& pages) { return {pages.point_pages, nullptr}; }

} // namespace tread::mpm
