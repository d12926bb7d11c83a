#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "io/h5_parts.hpp"

// Files that were written, by one process.
namespace tread::io::h5
{

namespace
{

/// Rows of a data set that must have `width` columns.
hsize_t rows_in(const File& file, const Handle& dataset, const std::string& name, int width)
{
    const Handle           space{H5Dget_space(dataset.id()), H5Sclose};
    const int              rank = H5Sget_simple_extent_ndims(space.id());
    std::array<hsize_t, 2> size{0, 1};
    if (rank == (width == 1 ? 1 : 2)) { H5Sget_simple_extent_dims(space.id(), size.data(), nullptr); }
    if (size[1] != static_cast<hsize_t>(width) || rank != (width == 1 ? 1 : 2))
    {
        throw EnvironmentError(fmt::format("{}: reading {} failed: it has not {} columns", file.path(), name, width));
    }
    return size[0];
}

} // namespace

template<class T>
std::vector<T> read(const File& file, const std::string& name, int width)
{
    const Handle   dataset = open_dataset(file, name);
    std::vector<T> values(rows_in(file, dataset, name, width) * static_cast<hsize_t>(width));
    check(H5Dread(dataset.id(), type_of<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), file, "reading " + name);
    return values;
}

template std::vector<double>       read(const File&, const std::string&, int);
template std::vector<std::int32_t> read(const File&, const std::string&, int);
template std::vector<std::uint8_t> read(const File&, const std::string&, int);

template<class T>
std::vector<T> read_rows(const File& file, const std::string& name, int width, hsize_t first, hsize_t count)
{
    const Handle  dataset = open_dataset(file, name);
    const hsize_t rows    = rows_in(file, dataset, name, width);
    if (first + count > rows)
    {
        throw EnvironmentError(
            fmt::format("{}: reading {} failed: {} rows, wanted up to {}", file.path(), name, rows, first + count));
    }
    std::vector<T> values(count * static_cast<hsize_t>(width));
    if (count == 0) { return values; }
    const Handle in_file{H5Dget_space(dataset.id()), H5Sclose};
    const Handle in_memory = dataspace(shape(count, width));
    select_rows(file, in_file, first, count, width);
    check(H5Dread(dataset.id(), type_of<T>(), in_memory.id(), in_file.id(), H5P_DEFAULT, values.data()), file,
          "reading " + name);
    return values;
}

template std::vector<double>        read_rows(const File&, const std::string&, int, hsize_t, hsize_t);
template std::vector<float>         read_rows(const File&, const std::string&, int, hsize_t, hsize_t);
template std::vector<std::int32_t>  read_rows(const File&, const std::string&, int, hsize_t, hsize_t);
template std::vector<std::int64_t>  read_rows(const File&, const std::string&, int, hsize_t, hsize_t);
template std::vector<std::uint32_t> read_rows(const File&, const std::string&, int, hsize_t, hsize_t);
template std::vector<std::uint64_t> read_rows(const File&, const std::string&, int, hsize_t, hsize_t);
template std::vector<std::uint8_t>  read_rows(const File&, const std::string&, int, hsize_t, hsize_t);

bool holds(const File& file, const std::string& name)
{
    for (std::size_t end = name.find('/', 1); end != std::string::npos; end = name.find('/', end + 1))
    {
        if (H5Lexists(file.id(), name.substr(0, end).c_str(), H5P_DEFAULT) <= 0) { return false; }
    }
    return H5Lexists(file.id(), name.c_str(), H5P_DEFAULT) > 0;
}

std::int64_t count_members(const File& file, const std::string& group)
{
    H5G_info_t   info;
    const Handle at{checked(H5Gopen2(file.id(), group.c_str(), H5P_DEFAULT), file.path(), "opening " + group),
                    H5Gclose};
    check(H5Gget_info(at.id(), &info), file, "reading " + group);
    return static_cast<std::int64_t>(info.nlinks);
}

std::string read_text_attribute(const File& file, const std::string& object, const std::string& name)
{
    const auto   what      = fmt::format("reading attribute {} of {}", name, object);
    const Handle attribute = open_attribute(file, object, name);
    const Handle type{H5Aget_type(attribute.id()), H5Tclose};
    if (H5Tis_variable_str(type.id()) <= 0)
    {
        throw EnvironmentError(fmt::format("{}: {} failed: it is no text", file.path(), what));
    }
    char* text = nullptr;
    check(H5Aread(attribute.id(), type.id(), &text), file, what);
    std::string value = text == nullptr ? "" : text;
    H5free_memory(text);
    return value;
}

double read_number_attribute(const File& file, const std::string& object, const std::string& name)
{
    double       value     = 0;
    const Handle attribute = open_attribute(file, object, name);
    check(H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, &value), file, "reading attribute " + name);
    return value;
}

std::vector<std::int64_t> read_numbers_attribute(const File& file, const std::string& object, const std::string& name)
{
    const auto   what      = fmt::format("reading attribute {} of {}", name, object);
    const Handle attribute = open_attribute(file, object, name);
    const Handle space{H5Aget_space(attribute.id()), H5Sclose};
    const auto   count = H5Sget_simple_extent_npoints(space.id());

    std::vector<std::int64_t> values(static_cast<std::size_t>(std::max<hssize_t>(count, 0)));
    check(H5Aread(attribute.id(), H5T_NATIVE_INT64, values.data()), file, what);
    return values;
}

} // namespace tread::io::h5
