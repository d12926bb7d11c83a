#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "io/h5.hpp"

namespace tread::io
{

/// A file written by all ranks. A failure on one is a failure on all, so that none waits in the next collective call.
/// Every call is collective.
class SharedFile
{
public:
    SharedFile(const Communicator& communicator, const std::string& path)
        : communicator_(communicator)
    {
        on_every_rank(communicator, [&] { file_.emplace(h5::File::create(path, communicator)); });
    }

    /// `work` takes the h5::File.
    template<class Work>
    void together(const Work& work)
    {
        on_every_rank(communicator_, [&] { work(*file_); });
    }

    /// Writes `values` = [rows][width] of this rank after those of the ranks before it.
    template<class T>
    void write(const std::string& name, const std::vector<T>& values, int width)
    {
        const h5::Rows rows = h5::rows_of_rank(communicator_, values.size() / static_cast<std::size_t>(width));
        together([&](const h5::File& h5) { h5::write(h5, name, values, width, rows); });
    }

    template<class T>
    void write_with_unit(const std::string& name, const std::vector<T>& values, int width, const std::string& unit)
    {
        write(name, values, width);
        together([&](const h5::File& h5) { h5::write_attribute(h5, name, "units", unit); });
    }

    void close()
    {
        together([](h5::File& h5) { h5.close(); });
    }

private:
    const Communicator&     communicator_;
    std::optional<h5::File> file_;
};

} // namespace tread::io
