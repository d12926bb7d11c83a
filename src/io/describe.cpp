#include "io/describe.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.hpp"
#include "base/printable.hpp"
#include "io/h5.hpp"
#include "io/in_child.hpp"

namespace tread::io
{

namespace
{

constexpr std::size_t most_values = 1000; ///< of an attribute that is shown

std::string type_name(hid_t type)
{
    const std::size_t bits = 8 * H5Tget_size(type);
    switch (H5Tget_class(type))
    {
    case H5T_FLOAT:
        return fmt::format("float{}", bits);
    case H5T_INTEGER:
        return fmt::format("{}int{}", H5Tget_sign(type) == H5T_SGN_NONE ? "u" : "", bits);
    case H5T_STRING:
        return "text";
    default:
        return "other";
    }
}

std::string text_value(const h5::Handle& attribute, const h5::Handle& type)
{
    if (H5Tis_variable_str(type.id()) > 0)
    {
        char* text = nullptr;
        if (H5Aread(attribute.id(), type.id(), &text) < 0 || text == nullptr) { return "?"; }
        std::string value = text;
        H5free_memory(text);
        return value;
    }
    std::string value(H5Tget_size(type.id()), '\0');
    if (H5Aread(attribute.id(), type.id(), value.data()) < 0) { return "?"; }
    value.erase(value.find_last_not_of('\0') + 1); // padding of a fixed-length string
    return value;
}

std::string attribute_value(const h5::Handle& attribute)
{
    const h5::Handle type{H5Aget_type(attribute.id()), H5Tclose};
    const h5::Handle space{H5Aget_space(attribute.id()), H5Sclose};
    const auto       count = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.id()));
    const auto       kind  = H5Tget_class(type.id());
    if (kind == H5T_STRING) { return count == 1 ? printable(text_value(attribute, type)) : "?"; }
    if (kind != H5T_INTEGER && kind != H5T_FLOAT) { return "?"; }
    if (count > most_values) { return fmt::format("{} values", count); }
    std::vector<double> values(count);
    if (H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, values.data()) < 0) { return "?"; }
    return fmt::format("{}", fmt::join(values, " "));
}

herr_t add_attribute(hid_t object, const char* name, const H5A_info_t*, void* text)
{
    const h5::Handle attribute{H5Aopen(object, name, H5P_DEFAULT), H5Aclose};
    *static_cast<std::string*>(text) += fmt::format("  {} = {}", printable(name), attribute_value(attribute));
    return 0;
}

std::string dataset_shape(hid_t dataset)
{
    const h5::Handle     space{H5Dget_space(dataset), H5Sclose};
    const h5::Handle     type{H5Dget_type(dataset), H5Tclose};
    std::vector<hsize_t> size(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space.id()))));
    H5Sget_simple_extent_dims(space.id(), size.data(), nullptr);
    return fmt::format("  [{}] {}", fmt::join(size, ", "), type_name(type.id()));
}

herr_t add_object(hid_t file, const char* name, const H5O_info_t* info, void* text)
{
    const bool       is_root = std::string(name) == ".";
    const h5::Handle object{H5Oopen(file, name, H5P_DEFAULT), H5Oclose};
    std::string&     lines = *static_cast<std::string*>(text);

    lines += is_root ? "/" : fmt::format("/{}", printable(name));
    if (info->type == H5O_TYPE_GROUP && !is_root) { lines += "/"; }
    if (info->type == H5O_TYPE_DATASET) { lines += dataset_shape(object.id()); }
    H5Aiterate2(object.id(), H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, add_attribute, &lines);
    lines += "\n";
    return 0;
}

} // namespace

std::string describe_here(const std::string& path)
{
    const h5::File file = h5::File::open(path);
    std::string    text;
    h5::checked(H5Ovisit(file.id(), H5_INDEX_NAME, H5_ITER_NATIVE, add_object, &text), path, "listing the file");
    return text;
}

std::string describe_file(const std::string& path)
{
    try
    {
        return run_in_child(path, [&] { return describe_here(path); });
    }
    catch (const EnvironmentError& error)
    {
        throw InputError(error.what());
    }
}

} // namespace tread::io
