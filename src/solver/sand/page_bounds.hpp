#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/mpm/pages/pages.hpp"
#include "solver/state_file.hpp"

namespace tread::solver
{

/// Checks loaded page tables (mpm::Pages), which refer to each other's rows, as far as the keys allow. Fields must
/// come in the order of Pages::for_each_field; fields that later ones refer to are kept.
class PageBounds
{
public:
    explicit PageBounds(std::int64_t points)
        : points_(points)
    {
    }

    /// Checks the field `name`; an unknown field is refused.
    template<class T>
    accept::Verdict operator()(const std::string& name, const std::vector<T>& values)
    {
        if constexpr (std::is_same_v<T, std::uint64_t>) { return keys(name, values); }
        else if constexpr (std::is_same_v<T, std::uint8_t>) { return places(name, values); }
        else { return numbers(name, values); }
    }

private:
    accept::Verdict keys(const std::string& name, const std::vector<std::uint64_t>& values);
    accept::Verdict places(const std::string& name, const std::vector<std::uint8_t>& values) const;
    accept::Verdict numbers(const std::string& name, const std::vector<std::int32_t>& values);
    accept::Verdict cells(const std::vector<std::int32_t>& values) const;
    accept::Verdict neighbours(const std::vector<std::int32_t>& values) const;
    accept::Verdict node_pages(const std::vector<std::int32_t>& values) const;
    accept::Verdict point_pages(const std::vector<std::int32_t>& values) const;

    std::int64_t               points_;
    std::vector<std::uint64_t> point_page_key_, node_page_key_;
    std::vector<std::int32_t>  first_point_, cell_first_point_;
};

} // namespace tread::solver
