#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "io/h5.hpp"

// A checkpoint: one HDF5 file with data sets of rows, each rank's behind those of the ranks before it, and 512 bytes
// before it that say how long the rest is and what its checksum must be.
namespace tread::io
{

/// Writes under another name until the file is whole. Every call is collective; a failure is an EnvironmentError, and
/// nothing is left of the file.
class CheckpointWriter
{
public:
    /// Several ranks ask for room for `expected` bytes first: MPI's collective calls never end where the disk of one
    /// rank is full.
    CheckpointWriter(const Communicator& communicator, std::string path, std::int64_t expected = 0);
    ~CheckpointWriter();
    CheckpointWriter(const CheckpointWriter&)            = delete;
    CheckpointWriter& operator=(const CheckpointWriter&) = delete;

    /// `values` = [rows][width] of this rank.
    template<class T>
    void write(const std::string& name, const std::vector<T>& values, int width);

    /// Attributes of the whole file.
    void text(const std::string& name, const std::string& value);
    void number(const std::string& name, std::int64_t value);

    const h5::File& file() const { return *file_; }

    /// The file is on the disk and has its name. Returns its bytes.
    std::int64_t finish();

private:
    const Communicator&     communicator_;
    std::string             path_;
    std::optional<h5::File> file_;
    bool                    finished_ = false;
};

/// Of one process.
class CheckpointReader
{
public:
    explicit CheckpointReader(const std::string& path)
        : file_(h5::File::open_received(path))
    {
    }

    const std::string& path() const { return file_.path(); }

    bool holds(const std::string& name) const { return h5::holds(file_, name); }

    /// [ranks + 1]: the rows of each rank that wrote, ascending from 0 to how many there are. EnvironmentError.
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

/// Collective: why a file cannot be used as a checkpoint, or nothing if it can: cut short, changed, of another kind or
/// of a newer schema.
std::optional<std::string> damage_of(const Communicator& communicator, const std::string& path);

} // namespace tread::io
