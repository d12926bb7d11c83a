#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "io/h5.hpp"

// Shared by h5.cpp and h5_read.cpp.
namespace tread::io::h5
{

template<class T>
hid_t type_of()
{
    if constexpr (std::is_same_v<T, double>) { return H5T_NATIVE_DOUBLE; }
    else if constexpr (std::is_same_v<T, float>) { return H5T_NATIVE_FLOAT; }
    else if constexpr (std::is_same_v<T, std::int32_t>) { return H5T_NATIVE_INT32; }
    else if constexpr (std::is_same_v<T, std::int64_t>) { return H5T_NATIVE_INT64; }
    else if constexpr (std::is_same_v<T, std::uint32_t>) { return H5T_NATIVE_UINT32; }
    else if constexpr (std::is_same_v<T, std::uint64_t>) { return H5T_NATIVE_UINT64; }
    else
    {
        static_assert(std::is_same_v<T, std::uint8_t>);
        return H5T_NATIVE_UINT8;
    }
}

/// EnvironmentError unless all contents are stored in the file itself (h5_received.cpp).
void require_self_contained(const File& file);

inline Handle property_list(hid_t kind) { return {H5Pcreate(kind), H5Pclose}; }

inline std::vector<hsize_t> shape(hsize_t rows, int width)
{
    if (width == 1) { return {rows}; }
    return {rows, static_cast<hsize_t>(width)};
}

inline Handle dataspace(const std::vector<hsize_t>& size)
{
    return {H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose};
}

inline void check(herr_t result, const File& file, const std::string& what) { checked(result, file.path(), what); }

inline void select_rows(const File& file, const Handle& space, hsize_t first, hsize_t count, int width)
{
    if (count == 0)
    {
        H5Sselect_none(space.id());
        return;
    }
    const std::vector<hsize_t> start{first, 0};
    const std::vector<hsize_t> size = shape(count, width);
    check(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr), file,
          "selecting rows");
}

inline Handle open_dataset(const File& file, const std::string& name)
{
    return {checked(H5Dopen2(file.id(), name.c_str(), H5P_DEFAULT), file.path(), "opening " + name), H5Dclose};
}

inline Handle open_attribute(const File& file, const std::string& object, const std::string& name)
{
    const hid_t id = H5Aopen_by_name(file.id(), object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    return {checked(id, file.path(), fmt::format("opening attribute {} of {}", name, object)), H5Aclose};
}

} // namespace tread::io::h5
