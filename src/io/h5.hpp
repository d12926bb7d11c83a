#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <hdf5.h>

#include "base/communicator.hpp"

// A minimal HDF5 interface. Failures are an EnvironmentError with the file's path and HDF5's reason.
namespace tread::io::h5
{

/// Call before MPI_Init. HDF5 then does not close open files in MPI_Finalize, where it would retry a write that a full
/// disk has refused and end the process by a signal. Every file is closed by its File, which reports failures.
void begin();

/// Owner of an open HDF5 object of any kind.
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

/// An open file. While several ranks hold it, every call below that takes it is collective. Closes itself, except a
/// file of several ranks, which stays open until close(): a rank that fails alone would wait for the others there.
class File
{
public:
    /// Creates a file, or truncates an existing one; this process alone.
    static File create(const std::string& path);

    /// Creates or truncates a file on all ranks of the communicator together through MPI-IO, without MPI if there is
    /// only one. `user_block`: bytes in front (0, or 512 times a power of 2) that HDF5 leaves alone.
    static File create(const std::string& path, const Communicator& communicator, hsize_t user_block = 0);

    /// Opens a file to append rows. Takes no file lock: a reader that has the file open must not end the run.
    static File append(const std::string& path);

    /// Opens a file for reading. EnvironmentError unless it is a regular file.
    static File open(const std::string& path);

    /// Opens a file of unknown origin for reading. EnvironmentError unless it is self-contained: links to other files
    /// or by name, external storage, filters and huge chunks are refused.
    static File open_received(const std::string& path);

    /// Closes the file and reports what the destructor cannot: data that never reached the disk.
    void close();

    hid_t              id() const { return handle_.id(); }
    const std::string& path() const { return path_; }
    hid_t              transfer() const { return transfer_.id(); }

private:
    File(hid_t id, std::string path, Handle transfer, Handle::Closer abandon = H5Fclose);

    Handle      handle_;
    std::string path_;
    Handle      transfer_; ///< transfer mode of raw data: collective for a file of several ranks
};

/// This rank's part of the rows of a data set.
struct Rows
{
    hsize_t total;
    hsize_t first;
    hsize_t count;
};

/// Rows of this rank if ranks hold `count` rows each, in rank order.
Rows rows_of_rank(const Communicator& communicator, std::size_t count);

void create_group(const File& file, const std::string& name);

/// Writes `values` = [rows.count][width], row-major; width 1 makes a one-dimensional data set. Groups are created if
/// needed. T: double, float, int32, int64, uint64, uint32, uint8.
template<class T>
void write(const File& file, const std::string& name, const std::vector<T>& values, int width, const Rows& rows);

/// Writes all rows from this process.
template<class T>
void write(const File& file, const std::string& name, const std::vector<T>& values, int width)
{
    const hsize_t count = values.size() / static_cast<hsize_t>(width);
    write(file, name, values, width, Rows{count, 0, count});
}

/// Reads all that `write` wrote, by this process alone. The data set must have `width` columns, of T's kind of number,
/// and no more values than the file holds and free memory allows.
template<class T>
std::vector<T> read(const File& file, const std::string& name, int width);

/// Reads `count` rows from `first` on.
template<class T>
std::vector<T> read_rows(const File& file, const std::string& name, int width, hsize_t first, hsize_t count);

/// Number of rows of a data set.
std::int64_t count_rows(const File& file, const std::string& name);

/// EnvironmentError unless append_rows can extend a data set: chunked storage in this file, doubles, `width` columns.
void require_growing(const File& file, const std::string& name, int width);

/// Whether an object of that path exists.
bool holds(const File& file, const std::string& name);

/// Number of objects in a group.
std::int64_t count_members(const File& file, const std::string& group);

/// Whether an object that exists has an attribute of that name.
bool holds_attribute(const File& file, const std::string& object, const std::string& name);

/// Reads an attribute written by write_attribute.
std::string read_text_attribute(const File& file, const std::string& object, const std::string& name);
double      read_number_attribute(const File& file, const std::string& object, const std::string& name);

std::vector<std::int64_t> read_numbers_attribute(const File& file, const std::string& object, const std::string& name);

/// Creates an empty data set of doubles that append_rows can extend.
void create_growing(const File& file, const std::string& name, int width);

/// Appends `values` = [rows][width].
void append_rows(const File& file, const std::string& name, const std::vector<double>& values, int width);

/// Writes an attribute. `object`: path of a group or data set; "/" for the root.
void write_attribute(const File& file, const std::string& object, const std::string& name, const std::string& value);
void write_attribute(const File& file, const std::string& object, const std::string& name, double value);
void write_attribute(const File& file, const std::string& object, const std::string& name,
                     const std::vector<std::int64_t>& values);

/// Writes a fixed-length ASCII string, which VTK's reader requires.
void write_fixed_attribute(const File& file, const std::string& object, const std::string& name,
                           const std::string& value);

/// Writes a fixed-length attribute, or overwrites one of the same length, so that the file does not grow.
void set_fixed_attribute(const File& file, const std::string& object, const std::string& name,
                         const std::string& value);

/// Returns `id`, or throws if it is invalid. `what` and `path` go into the message.
hid_t checked(hid_t id, const std::string& path, const std::string& what);

} // namespace tread::io::h5
