#include "io/h5.hpp"

#include <fmt/format.h>

#include "base/errors.hpp"
#include "base/regular_file.hpp"
#include "io/files.hpp"
#include "io/h5_parts.hpp"

namespace tread::io::h5
{

namespace
{

// Rows by which a growing data set is extended: 8 KiB per column.
constexpr hsize_t growth = 1024;

// The innermost entry of the error stack is the most specific: "unable to create file: ... Permission denied".
herr_t take_innermost(unsigned depth, const H5E_error2_t* entry, void* reason)
{
    if (depth == 0 && entry->desc != nullptr) { *static_cast<std::string*>(reason) = entry->desc; }
    return 0;
}

// Call before anything may fail: by default HDF5 prints its whole stack to standard error.
void silence() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

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

/// Closes a data set. Small data sets and chunks are written only now, and no other call reports that they were not.
void close_written(Handle& dataset, const File& file, const std::string& what)
{
    check(H5Dclose(dataset.release()), file, what);
}

herr_t leave_open(hid_t) { return 0; }

Handle links_with_groups()
{
    Handle links = property_list(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links.id(), 1);
    return links;
}

} // namespace

void begin()
{
    H5dont_atexit();
    if (H5open() < 0) { throw EnvironmentError("HDF5: the library cannot be used"); }
}

hid_t checked(hid_t id, const std::string& path, const std::string& what)
{
    if (id >= 0) { return id; }
    std::string reason = "no reason given";
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_innermost, &reason);
    throw EnvironmentError(fmt::format("{}: HDF5: {} failed: {}", path, what, reason));
}

File::File(hid_t id, std::string path, Handle transfer, Handle::Closer abandon)
    : handle_(id, abandon)
    , path_(std::move(path))
    , transfer_(std::move(transfer))
{
}

File File::create(const std::string& path)
{
    silence();
    remove_name(path);
    const hid_t id = H5Fcreate(path.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT);
    return {checked(id, path, "creating the file"), path, property_list(H5P_DATASET_XFER)};
}

File File::create(const std::string& path, const Communicator& communicator, hsize_t user_block)
{
    silence();
    const bool   alone    = communicator.size() == 1;
    const Handle access   = alone ? property_list(H5P_FILE_ACCESS) : parallel_access(path, communicator);
    Handle       transfer = alone ? property_list(H5P_DATASET_XFER) : collective_transfer();
    const Handle creation = property_list(H5P_FILE_CREATE);
    H5Pset_userblock(creation.id(), user_block);
    if (communicator.rank() == 0) { remove_name(path); }
    communicator.barrier();
    const hid_t id = H5Fcreate(path.c_str(), H5F_ACC_EXCL, creation.id(), access.id());
    return {checked(id, path, "creating the file"), path, std::move(transfer), alone ? H5Fclose : leave_open};
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
    require_regular(path);
    const Handle access = property_list(H5P_FILE_ACCESS);
    H5Pset_file_locking(access.id(), false, true);
    const hid_t id = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id());
    return {checked(id, path, "opening the file"), path, property_list(H5P_DATASET_XFER)};
}

File File::open_received(const std::string& path)
{
    File file = open(path);
    require_self_contained(file);
    return file;
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
    Handle dataset{checked(id, file.path(), what), H5Dclose};

    const Handle in_memory = dataspace(shape(rows.count, width));
    if (rows.count == 0) { H5Sselect_none(in_memory.id()); }
    select_rows(file, in_file, rows.first, rows.count, width);
    check(H5Dwrite(dataset.id(), type_of<T>(), in_memory.id(), in_file.id(), file.transfer(), values.data()), file,
          what);
    close_written(dataset, file, what);
}

template void write(const File&, const std::string&, const std::vector<double>&, int, const Rows&);
template void write(const File&, const std::string&, const std::vector<float>&, int, const Rows&);
template void write(const File&, const std::string&, const std::vector<std::int32_t>&, int, const Rows&);
template void write(const File&, const std::string&, const std::vector<std::int64_t>&, int, const Rows&);
template void write(const File&, const std::string&, const std::vector<std::uint32_t>&, int, const Rows&);
template void write(const File&, const std::string&, const std::vector<std::uint64_t>&, int, const Rows&);
template void write(const File&, const std::string&, const std::vector<std::uint8_t>&, int, const Rows&);

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
    Handle dataset{checked(id, file.path(), "creating " + name), H5Dclose};
    close_written(dataset, file, "creating " + name);
}

void append_rows(const File& file, const std::string& name, const std::vector<double>& values, int width)
{
    const std::string what    = "appending to " + name;
    const hsize_t     count   = values.size() / static_cast<hsize_t>(width);
    Handle            dataset = open_dataset(file, name);

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
    close_written(dataset, file, what);
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
    if (!holds_attribute(file, object, name))
    {
        write_fixed_attribute(file, object, name, value);
        return;
    }
    const Handle attribute = open_attribute(file, object, name);
    const Handle type{H5Aget_type(attribute.id()), H5Tclose};
    check(H5Awrite(attribute.id(), type.id(), value.data()), file, "writing attribute " + name);
}

} // namespace tread::io::h5
