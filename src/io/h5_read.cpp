#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "base/host_memory.hpp"
#include "io/h5_parts.hpp"

// Reading of files, by one process.
namespace tread::io::h5
{

namespace
{

template<class T>
constexpr H5T_class_t kind_of = std::is_floating_point_v<T> ? H5T_FLOAT : H5T_INTEGER;

std::string name_of(H5T_class_t kind)
{
    return kind == H5T_FLOAT ? "floating-point numbers" : kind == H5T_INTEGER ? "integers" : "no numbers";
}

/// Call before memory for the values is allocated.
template<class T>
void require_readable(const File& file, const Handle& dataset, const std::string& name, hsize_t rows, int width)
{
    const Handle type{H5Dget_type(dataset.id()), H5Tclose};
    const auto   refuse = [&](const std::string& what)
    { throw EnvironmentError(fmt::format("{}: reading {} failed: {}", file.path(), name, what)); };
    const H5T_class_t kind = H5Tget_class(type.id());
    const std::size_t size = H5Tget_size(type.id());
    if (kind != kind_of<T> || size > sizeof(double))
    {
        refuse(fmt::format("it holds {} of {} bytes; accepted: {}", name_of(kind), size, name_of(kind_of<T>)));
    }
    const double values = static_cast<double>(rows) * width;
    const auto   stored = static_cast<double>(std::filesystem::file_size(file.path()));
    if (values * static_cast<double>(size) > stored)
    {
        refuse(fmt::format("it declares {} rows; accepted: what a file of {:.0f} bytes can hold", rows, stored));
    }
    if (values * sizeof(T) > static_cast<double>(available_host_memory()))
    {
        refuse(fmt::format("it holds {:.3g} MB, and {:.3g} MB of memory are free", values * sizeof(T) / 1e6,
                           static_cast<double>(available_host_memory()) / 1e6));
    }
}

/// EnvironmentError unless an attribute has `count` values, of numbers or of text.
void require_attribute(const File& file, const Handle& attribute, const std::string& what, hssize_t count,
                       bool fits_kind)
{
    const Handle space{H5Aget_space(attribute.id()), H5Sclose};
    if (fits_kind && H5Sget_simple_extent_npoints(space.id()) == count) { return; }
    throw EnvironmentError(fmt::format("{}: {} failed: it is not what tread writes there", file.path(), what));
}

bool holds_numbers(const Handle& attribute)
{
    const Handle type{H5Aget_type(attribute.id()), H5Tclose};
    const auto   kind = H5Tget_class(type.id());
    return (kind == H5T_INTEGER || kind == H5T_FLOAT) && H5Tget_size(type.id()) <= sizeof(double);
}

/// Number of rows of a data set that must have `width` columns.
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
    const Handle  dataset = open_dataset(file, name);
    const hsize_t rows    = rows_in(file, dataset, name, width);
    require_readable<T>(file, dataset, name, rows, width);
    std::vector<T> values(rows * static_cast<hsize_t>(width));
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
    if (first > rows || count > rows - first)
    {
        throw EnvironmentError(fmt::format("{}: reading {} failed: {} rows; accepted: at least {}", file.path(), name,
                                           rows, first + count));
    }
    require_readable<T>(file, dataset, name, rows, width);
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

std::int64_t count_rows(const File& file, const std::string& name)
{
    const Handle dataset = open_dataset(file, name);
    const Handle space{H5Dget_space(dataset.id()), H5Sclose};
    hsize_t      size[H5S_MAX_RANK] = {};
    if (H5Sget_simple_extent_dims(space.id(), size, nullptr) < 1)
    {
        throw EnvironmentError(fmt::format("{}: reading {} failed: it has no rows", file.path(), name));
    }
    return static_cast<std::int64_t>(std::min<hsize_t>(size[0], std::numeric_limits<std::int64_t>::max()));
}

void require_growing(const File& file, const std::string& name, int width)
{
    const Handle  dataset = open_dataset(file, name);
    const Handle  creation{H5Dget_create_plist(dataset.id()), H5Pclose};
    const hsize_t rows = rows_in(file, dataset, name, width);
    require_readable<double>(file, dataset, name, rows, width);
    const Handle space{H5Dget_space(dataset.id()), H5Sclose};
    hsize_t      size[2] = {}, most[2] = {};
    H5Sget_simple_extent_dims(space.id(), size, most);
    if (H5Pget_layout(creation.id()) == H5D_CHUNKED && most[0] == H5S_UNLIMITED) { return; }
    throw EnvironmentError(fmt::format("{}: {}: it does not grow, as a time series does", file.path(), name));
}

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

bool holds_attribute(const File& file, const std::string& object, const std::string& name)
{
    return H5Aexists_by_name(file.id(), object.c_str(), name.c_str(), H5P_DEFAULT) > 0;
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
    require_attribute(file, attribute, what, 1, true);
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
    require_attribute(file, attribute, "reading attribute " + name, 1, holds_numbers(attribute));
    check(H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, &value), file, "reading attribute " + name);
    return value;
}

std::vector<std::int64_t> read_numbers_attribute(const File& file, const std::string& object, const std::string& name)
{
    const auto   what      = fmt::format("reading attribute {} of {}", name, object);
    const Handle attribute = open_attribute(file, object, name);
    const Handle space{H5Aget_space(attribute.id()), H5Sclose};
    const auto   count = H5Sget_simple_extent_npoints(space.id());
    const bool   sane  = count >= 0 && static_cast<std::uintmax_t>(count) <= std::filesystem::file_size(file.path());
    require_attribute(file, attribute, what, count, sane && holds_numbers(attribute));

    std::vector<std::int64_t> values(static_cast<std::size_t>(count));
    check(H5Aread(attribute.id(), H5T_NATIVE_INT64, values.data()), file, what);
    return values;
}

} // namespace tread::io::h5
