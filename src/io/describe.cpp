#include "io/describe.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.hpp"
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

/// Bytes of the character that a text begins with; 0 if it is none of UTF-8, or one that a terminal would obey.
std::size_t plain_bytes(std::string_view text)
{
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    if (byte(0) < 0x80) { return byte(0) >= 0x20 ? byte(0) != 0x7f : byte(0) == '\n' || byte(0) == '\t'; }
    const std::size_t bytes = byte(0) < 0xc2 ? 0 : byte(0) < 0xe0 ? 2 : byte(0) < 0xf0 ? 3 : byte(0) < 0xf5 ? 4 : 0;
    if (bytes == 0 || text.size() < bytes) { return 0; }
    for (std::size_t i = 1; i < bytes; ++i)
    {
        if ((byte(i) & 0xc0) != 0x80) { return 0; }
    }
    const bool control = byte(0) == 0xc2 && byte(1) < 0xa0; // C1
    const bool beyond  = (byte(0) == 0xe0 && byte(1) < 0xa0) || (byte(0) == 0xed && byte(1) > 0x9f) ||
                        (byte(0) == 0xf0 && byte(1) < 0x90) || (byte(0) == 0xf4 && byte(1) > 0x8f);
    return control || beyond ? 0 : bytes;
}

/// The same without what a terminal would obey.
std::string printable(const std::string& text)
{
    std::string shown;
    for (std::size_t at = 0; at < text.size();)
    {
        const std::size_t bytes = plain_bytes(std::string_view(text).substr(at));
        shown += bytes > 0 ? text.substr(at, bytes) : fmt::format("\\x{:02x}", static_cast<unsigned char>(text[at]));
        at += std::max<std::size_t>(bytes, 1);
    }
    return shown;
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
