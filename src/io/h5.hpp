#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <hdf5.h>

#include "base/communicator.hpp"

// HDF5, as little as tread needs of it. What fails is an EnvironmentError with the file's path and HDF5's reason.
namespace tread::io::h5
{

/// To be called before MPI begins. HDF5 then leaves its open files alone when MPI ends: it would once more write what a
/// full disk has refused, and end the process by a signal. Every file is closed by its File, which says what fails.
void begin();

/// An open HDF5 object of any kind; closes itself.
class Handle
{
public:
    using Closer = herr_t (*)(hid_t);

    Handle(hid_t id, Closer close)
        : id_(id)
        , close_(close)
    {
    }
    Handle(Handle&& other) noexcept
        : id_(std::exchange(other.id_, H5I_INVALID_HID))
        , close_(other.close_)
    {
    }
    Handle& operator=(Handle&&) = delete;
    ~Handle()
    {
        if (id_ >= 0) { close_(id_); }
    }

    hid_t id() const { return id_; }
    hid_t release() { return std::exchange(id_, H5I_INVALID_HID); }

private:
    hid_t  id_;
    Closer close_;
};

/// An open file. While several ranks hold it, every call below that takes it is collective. Closes itself, but for a
/// file of several ranks, which stays open until close(): a rank that fails alone would wait for the others there.
class File
{
public:
    /// New, or emptied if there was one; this process alone.
    static File create(const std::string& path);

    /// New, or emptied; all ranks of the communicator together through MPI-IO, without MPI where there is only one.
    /// Before it are `user_block` bytes (0, or 512 times a power of 2) that HDF5 leaves to others.
    static File create(const std::string& path, const Communicator& communicator, hsize_t user_block = 0);

    /// For more rows. Takes no file lock: a reader that has the file open must not end the run.
    static File append(const std::string& path);

    /// To be read. EnvironmentError unless it is a regular file.
    static File open(const std::string& path);

    /// The same of a file that may come from anywhere. EnvironmentError unless all that it holds is its own: links that
    /// lead to other files or by name, storage in other files, filters and huge chunks are refused.
    static File open_received(const std::string& path);

    /// Reports what the destructor could not: data that never reached the disk.
    void close();

    hid_t              id() const { return handle_.id(); }
    const std::string& path() const { return path_; }
    hid_t              transfer() const { return transfer_.id(); }

private:
    File(hid_t id, std::string path, Handle transfer, Handle::Closer abandon = H5Fclose);

    Handle      handle_;
    std::string path_;
    Handle      transfer_; ///< how raw data move: collectively on a file of several ranks
};

/// A rank's part of the rows of a data set.
struct Rows
{
    hsize_t total;
    hsize_t first;
    hsize_t count;
};

/// This rank's rows when every rank has `count`, in rank order.
Rows rows_of_rank(const Communicator& communicator, std::size_t count);

void create_group(const File& file, const std::string& name);

/// `values` = [rows.count][width], row-major; width 1 makes a one-dimensional data set, in groups that are made if need
/// be. T: double, float, int32, int64, uint64, uint32, uint8.
template<class T>
void write(const File& file, const std::string& name, const std::vector<T>& values, int width, const Rows& rows);

/// All rows by this process.
template<class T>
void write(const File& file, const std::string& name, const std::vector<T>& values, int width)
{
    const hsize_t count = values.size() / static_cast<hsize_t>(width);
    write(file, name, values, width, Rows{count, 0, count});
}

/// What `write` wrote, by this process alone. The data set must have `width` columns, of numbers of T's kind, and no
/// more values than the file and the free memory have room for.
template<class T>
std::vector<T> read(const File& file, const std::string& name, int width);

/// The same of `count` rows from `first` on.
template<class T>
std::vector<T> read_rows(const File& file, const std::string& name, int width, hsize_t first, hsize_t count);

/// Rows of a data set.
std::int64_t count_rows(const File& file, const std::string& name);

/// EnvironmentError unless a data set grows by append_rows: its own storage in chunks, doubles, `width` columns.
void require_growing(const File& file, const std::string& name, int width);

/// Whether there is an object of that path.
bool holds(const File& file, const std::string& name);

/// How many objects a group holds.
std::int64_t count_members(const File& file, const std::string& group);

/// Attributes that write_attribute wrote.
std::string read_text_attribute(const File& file, const std::string& object, const std::string& name);
double      read_number_attribute(const File& file, const std::string& object, const std::string& name);

std::vector<std::int64_t> read_numbers_attribute(const File& file, const std::string& object, const std::string& name);

/// An empty data set of doubles that grows by append_rows.
void create_growing(const File& file, const std::string& name, int width);

/// `values` = [rows][width] behind what is there.
void append_rows(const File& file, const std::string& name, const std::vector<double>& values, int width);

/// `object` is the path of a group or data set; "/" the file's root.
void write_attribute(const File& file, const std::string& object, const std::string& name, const std::string& value);
void write_attribute(const File& file, const std::string& object, const std::string& name, double value);
void write_attribute(const File& file, const std::string& object, const std::string& name,
                     const std::vector<std::int64_t>& values);

/// As a string of fixed length in ASCII, which is what VTK's reader accepts.
void write_fixed_attribute(const File& file, const std::string& object, const std::string& name,
                           const std::string& value);

/// The same for one that may be there already, of the same length: it is written over, and the file does not grow.
void set_fixed_attribute(const File& file, const std::string& object, const std::string& name,
                         const std::string& value);

/// Throws unless `id` is valid; else passes it on. `what` and `path` go into the message.
hid_t checked(hid_t id, const std::string& path, const std::string& what);

} // namespace tread::io::h5
