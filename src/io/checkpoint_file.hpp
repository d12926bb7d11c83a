#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "io/h5.hpp"

// A checkpoint is one HDF5 file with data sets of rows, in rank order, preceded by a head of 512 bytes with the length
// and checksum of the rest.
namespace tread::io
{

/// Writes a checkpoint under a temporary name until it is complete. Every call is collective; a failure is an
/// EnvironmentError, and no file is left behind.
class CheckpointWriter
{
public:
    /// `expected`: bytes of disk space that several ranks reserve first, because MPI's collective calls hang if the
    /// disk of one rank is full.
    CheckpointWriter(const Communicator& communicator, std::string path, std::int64_t expected = 0);
    ~CheckpointWriter();
    CheckpointWriter(const CheckpointWriter&)            = delete;
    CheckpointWriter& operator=(const CheckpointWriter&) = delete;

    /// Writes `values` = [rows][width] of this rank.
    template<class T>
    void write(const std::string& name, const std::vector<T>& values, int width);

    /// Writes an attribute of the whole file.
    void text(const std::string& name, const std::string& value);
    void number(const std::string& name, std::int64_t value);

    const h5::File& file() const { return *file_; }

    /// Flushes the file to disk and renames it. Returns its size in bytes.
    std::int64_t finish();

private:
    const Communicator&     communicator_;
    std::string             path_;
    std::optional<h5::File> file_;
    bool                    finished_ = false;
};

/// Reads a checkpoint; used by one process.
class CheckpointReader
{
public:
    explicit CheckpointReader(const std::string& path)
        : file_(h5::File::open_received(path))
    {
    }

    const std::string& path() const { return file_.path(); }

    bool holds(const std::string& name) const { return h5::holds(file_, name); }

    /// [ranks + 1]: first row of each rank of the writing run, ascending from 0 to the number of rows.
    /// EnvironmentError.
    std::vector<std::int64_t> first_rows(const std::string& name) const;

    template<class T>
    std::vector<T> read(const std::string& name, int width, std::int64_t first, std::int64_t count) const
    {
        return h5::read_rows<T>(file_, name, width, static_cast<hsize_t>(first), static_cast<hsize_t>(count));
    }

    std::string  text(const std::string& name) const { return h5::read_text_attribute(file_, "/", name); }
    std::int64_t number(const std::string& name) const { return h5::read_numbers_attribute(file_, "/", name).at(0); }

private:
    h5::File file_;
};

/// Why a file cannot be used as a checkpoint: truncated, changed, of another kind or schema; empty if it can.
/// Collective.
std::optional<std::string> damage_of(const Communicator& communicator, const std::string& path);

} // namespace tread::io
