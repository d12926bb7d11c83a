#include "io/h5.hpp"

#include <algorithm>
#include <array>
#include <type_traits>

#include <fmt/format.h>

namespace tread::io::h5
{

namespace
{

// Rows that a growing data set takes at a time: 8 KiB a column.
constexpr hsize_t growth = 1024;

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

// The error stack's innermost entry says most: "unable to create file: ... Permission denied".
herr_t take_innermost(unsigned depth, const H5E_error2_t* entry, void* reason)
{
    if (depth == 0 && entry->desc != nullptr) { *static_cast<std::string*>(reason) = entry->desc; }
    return 0;
}

// Called before anything may fail: HDF5 prints its whole stack to standard error unless told not to.
void silence() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

Handle property_list(hid_t kind) { return {H5Pcreate(kind), H5Pclose}; }

std::vector<hsize_t> shape(hsize_t rows, int width)
{
    if (width == 1) { return {rows}; }
    return {rows, static_cast<hsize_t>(width)};
}

Handle dataspace(const std::vector<hsize_t>& size)
{
    return {H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose};
}

void check(herr_t result, const File& file, const std::string& what) { checked(result, file.path(), what); }

void select_rows(const File& file, const Handle& space, hsize_t first, hsize_t count, int width)
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

Handle open_dataset(const File& file, const std::string& name)
{
    return {checked(H5Dopen2(file.id(), name.c_str(), H5P_DEFAULT), file.path(), "opening " + name), H5Dclose};
}

Handle open_attribute(const File& file, const std::string& object, const std::string& name)
{
    const hid_t id = H5Aopen_by_name(file.id(), object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
    return {checked(id, file.path(), fmt::format("opening attribute {} of {}", name, object)), H5Aclose};
}

void write_attribute_data(const File& file, const std::string& object, const std::string& name, hid_t type,
                          const Handle& space, const void* data)
{
    const std::string what = fmt::format("writing attribute {} of {}", name, object);
    const Handle      at{checked(H5Oopen(file.id(), object.c_str(), H5P_DEFAULT), file.path(), what), H5Oclose};
    const Handle      attribute{
        checked(H5Acreate2(at.id(), name.c_str(), type, space.id(), H5P_DEFAULT, H5P_DEFAULT), file.path(), what),
        H5Aclose};
    check(H5Awrite(attribute.id(), type, data), file, what);
}

Handle parallel_access(const std::string& path, const Communicator& communicator)
{
    Handle access = property_list(H5P_FILE_ACCESS);
    checked(H5Pset_fapl_mpio(access.id(), communicator.native(), MPI_INFO_NULL), path, "setting up MPI-IO");
    H5Pset_coll_metadata_write(access.id(), true);
    return access;
}

Handle collective_transfer()
{
    Handle transfer = property_list(H5P_DATASET_XFER);
    H5Pset_dxpl_mpio(transfer.id(), H5FD_MPIO_COLLECTIVE);
    return transfer;
}

Handle links_with_groups()
{
    Handle links = property_list(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links.id(), 1);
    return links;
}

} // namespace

hid_t checked(hid_t id, const std::string& path, const std::string& what)
{
    if (id >= 0) { return id; }
    std::string reason = "no reason given";
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_innermost, &reason);
    throw EnvironmentError(fmt::format("{}: HDF5: {} failed: {}", path, what, reason));
}

File::File(hid_t id, std::string path, Handle transfer)
    : handle_(id, H5Fclose)
    , path_(std::move(path))
    , transfer_(std::move(transfer))
{
}

File File::create(const std::string& path)
{
    silence();
    const hid_t id = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    return {checked(id, path, "creating the file"), path, property_list(H5P_DATASET_XFER)};
}

File File::create(const std::string& path, const Communicator& communicator)
{
    silence();
    const Handle access   = parallel_access(path, communicator);
    Handle       transfer = collective_transfer();
    const hid_t  id       = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.id());
    return {checked(id, path, "creating the file"), path, std::move(transfer)};
}

File File::create(const std::string& path, const Communicator& communicator, hsize_t user_block)
{
    silence();
    const bool   alone    = communicator.size() == 1;
    const Handle access   = alone ? property_list(H5P_FILE_ACCESS) : parallel_access(path, communicator);
    Handle       transfer = alone ? property_list(H5P_DATASET_XFER) : collective_transfer();
    const Handle creation = property_list(H5P_FILE_CREATE);
    H5Pset_userblock(creation.id(), user_block);
    const hid_t id = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.id(), access.id());
    return {checked(id, path, "creating the file"), path, std::move(transfer)};
}

File File::append(const std::string& path)
{
    silence();
    const Handle access = property_list(H5P_FILE_ACCESS);
    H5Pset_file_locking(access.id(), false, true);
    const hid_t id = H5Fopen(path.c_str(), H5F_ACC_RDWR, access.id());
    return {checked(id, path, "opening the file"), path, property_list(H5P_DATASET_XFER)};
}

File File::open(const std::string& path)
{
    silence();
    const Handle access = property_list(H5P_FILE_ACCESS);
    H5Pset_file_locking(access.id(), false, true);
    const hid_t id = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id());
    return {checked(id, path, "opening the file"), path, property_list(H5P_DATASET_XFER)};
}

void File::close() { check(H5Fclose(handle_.release()), *this, "closing the file"); }

Rows rows_of_rank(const Communicator& communicator, std::size_t count)
{
    const std::vector<std::int64_t> counts = communicator.gather(static_cast<std::int64_t>(count));

    Rows rows{0, 0, count};
    for (std::size_t rank = 0; rank < counts.size(); ++rank)
    {
        const auto rows_there = static_cast<hsize_t>(counts[rank]);
        if (static_cast<int>(rank) < communicator.rank()) { rows.first += rows_there; }
        rows.total += rows_there;
    }
    return rows;
}

void create_group(const File& file, const std::string& name)
{
    const Handle links = links_with_groups();
    const hid_t  id    = H5Gcreate2(file.id(), name.c_str(), links.id(), H5P_DEFAULT, H5P_DEFAULT);
    const Handle group{checked(id, file.path(), "creating group " + name), H5Gclose};
}

template<class T>
void write(const File& file, const std::string& name, const std::vector<T>& values, int width, const Rows& rows)
{
    const std::string what     = "writing " + name;
    const Handle      in_file  = dataspace(shape(rows.total, width));
    const Handle      creation = property_list(H5P_DATASET_CREATE);
    H5Pset_fill_time(creation.id(), H5D_FILL_TIME_NEVER);
    const Handle links = links_with_groups();
    const hid_t  id =
        H5Dcreate2(file.id(), name.c_str(), type_of<T>(), in_file.id(), links.id(), creation.id(), H5P_DEFAULT);
    const Handle dataset{checked(id, file.path(), what), H5Dclose};

    const Handle in_memory = dataspace(shape(rows.count, width));
    if (rows.count == 0) { H5Sselect_none(in_memory.id()); }
    select_rows(file, in_file, rows.first, rows.count, width);
    check(H5Dwrite(dataset.id(), type_of<T>(), in_memory.id(), in_file.id(), file.transfer(), values.data()), file,
          what);
}

template void write(const File&, const std::string&, const std::vector<double>&, int, const Rows&);
template void write(const File&, const std::string&, const std::vector<float>&, int, const Rows&);
template void write(const File&, const std::string&, const std::vector<std::int32_t>&, int, const Rows&);
template void write(const File&, const std::string&, const std::vector<std::int64_t>&, int, const Rows&);
template void write(const File&, const std::string&, const std::vector<std::uint32_t>&, int, const Rows&);
template void write(const File&, const std::string&, const std::vector<std::uint64_t>&, int, const Rows&);
template void write(const File&, const std::string&, const std::vector<std::uint8_t>&, int, const Rows&);

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

void create_growing(const File& file, const std::string& name, int width)
{
    std::vector<hsize_t> most       = shape(0, width);
    std::vector<hsize_t> chunk      = most;
    most[0]                         = H5S_UNLIMITED;
    chunk[0]                        = growth;
    const std::vector<hsize_t> none = shape(0, width);

    const Handle space{H5Screate_simple(static_cast<int>(none.size()), none.data(), most.data()), H5Sclose};
    const Handle creation = property_list(H5P_DATASET_CREATE);
    H5Pset_chunk(creation.id(), static_cast<int>(chunk.size()), chunk.data());
    const hid_t id =
        H5Dcreate2(file.id(), name.c_str(), H5T_NATIVE_DOUBLE, space.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT);
    const Handle dataset{checked(id, file.path(), "creating " + name), H5Dclose};
}

void append_rows(const File& file, const std::string& name, const std::vector<double>& values, int width)
{
    const std::string what    = "appending to " + name;
    const hsize_t     count   = values.size() / static_cast<hsize_t>(width);
    const Handle      dataset = open_dataset(file, name);

    hsize_t size[2] = {0, 0};
    {
        const Handle before{H5Dget_space(dataset.id()), H5Sclose};
        H5Sget_simple_extent_dims(before.id(), size, nullptr);
    }
    const hsize_t first = size[0];
    size[0] += count;
    check(H5Dset_extent(dataset.id(), size), file, what);

    const Handle in_file{H5Dget_space(dataset.id()), H5Sclose};
    const Handle in_memory = dataspace(shape(count, width));
    select_rows(file, in_file, first, count, width);
    check(H5Dwrite(dataset.id(), H5T_NATIVE_DOUBLE, in_memory.id(), in_file.id(), file.transfer(), values.data()), file,
          what);
}

void write_attribute(const File& file, const std::string& object, const std::string& name, const std::string& value)
{
    const Handle type{H5Tcopy(H5T_C_S1), H5Tclose};
    H5Tset_size(type.id(), H5T_VARIABLE);
    H5Tset_cset(type.id(), H5T_CSET_UTF8);
    const char* text = value.c_str();
    write_attribute_data(file, object, name, type.id(), {H5Screate(H5S_SCALAR), H5Sclose}, &text);
}

void write_attribute(const File& file, const std::string& object, const std::string& name, double value)
{
    write_attribute_data(file, object, name, H5T_NATIVE_DOUBLE, {H5Screate(H5S_SCALAR), H5Sclose}, &value);
}

void write_attribute(const File& file, const std::string& object, const std::string& name,
                     const std::vector<std::int64_t>& values)
{
    write_attribute_data(file, object, name, H5T_NATIVE_INT64, dataspace({values.size()}), values.data());
}

void write_fixed_attribute(const File& file, const std::string& object, const std::string& name,
                           const std::string& value)
{
    const Handle type{H5Tcopy(H5T_C_S1), H5Tclose};
    H5Tset_size(type.id(), value.size());
    H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
    write_attribute_data(file, object, name, type.id(), {H5Screate(H5S_SCALAR), H5Sclose}, value.data());
}

void set_fixed_attribute(const File& file, const std::string& object, const std::string& name, const std::string& value)
{
    if (H5Aexists_by_name(file.id(), object.c_str(), name.c_str(), H5P_DEFAULT) <= 0)
    {
        write_fixed_attribute(file, object, name, value);
        return;
    }
    const Handle attribute = open_attribute(file, object, name);
    const Handle type{H5Aget_type(attribute.id()), H5Tclose};
    check(H5Awrite(attribute.id(), type.id(), value.data()), file, "writing attribute " + name);
}

} // namespace tread::io::h5
