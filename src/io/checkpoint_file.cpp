#include "io/checkpoint_file.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.hpp"
#include "base/regular_file.hpp"
#include "io/checksum.hpp"
#include "io/describe.hpp"
#include "io/files.hpp"
#include "io/in_child.hpp"

namespace tread::io
{
namespace
{

constexpr const char*                 mark       = "tread checkpoint";
constexpr const char*                 first_rows = "first_row"; ///< attribute of each data set
constexpr std::array<std::int64_t, 2> schema{7, 0};             ///< a reader refuses another first number
constexpr std::int64_t                head_bytes = 512;

struct Head
{
    std::int64_t  bytes    = 0; ///< of the whole file
    std::uint64_t checksum = 0; ///< of everything after the head
};

std::string text_of(const Head& head)
{
    std::string text = fmt::format("{}\nbytes {}\nchecksum {:016x}\n", mark, head.bytes, head.checksum);
    text.resize(static_cast<std::size_t>(head_bytes), '\0');
    return text;
}

std::optional<Head> head_of(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    std::string   text(static_cast<std::size_t>(head_bytes), '\0'), line, word;
    Head          head;
    if (!file.read(text.data(), head_bytes)) { return {}; }
    std::istringstream in(text);
    if (!std::getline(in, line) || line != mark) { return {}; }
    if (!(in >> word >> head.bytes) || word != "bytes") { return {}; }
    if (!(in >> word >> std::hex >> head.checksum) || word != "checksum") { return {}; }
    if (text_of(head) != text) { return {}; }
    return head;
}

std::int64_t bytes_of(const std::string& path)
{
    std::error_code error;
    const auto      bytes = std::filesystem::file_size(path, error);
    if (error) { throw EnvironmentError(fmt::format("{}: {}", path, error.message())); }
    return static_cast<std::int64_t>(bytes);
}

std::string temporary(const std::string& path) { return path + ".tmp"; }

/// Why the file is damaged, as far as the head and its length show.
std::optional<std::string> damage_of_head(const std::string& path, const std::optional<Head>& head)
{
    if (!head) { return "it is no checkpoint, or its first bytes are damaged"; }
    const std::int64_t bytes = bytes_of(path);
    if (bytes != head->bytes) { return fmt::format("it has {} bytes of {}", bytes, head->bytes); }
    return {};
}

/// Whether this rank sees a different file than rank 0. Compares heads, which hold the length and the checksum of the
/// rest.
std::string stranger(const Communicator& communicator, const std::optional<Head>& head)
{
    const std::vector<std::string> heads = communicator.gather(head ? text_of(*head) : "");
    const auto                     other =
        std::find_if(heads.begin(), heads.end(), [&](const auto& text) { return text != heads.front(); });
    if (other == heads.end()) { return ""; }
    const auto rank = static_cast<int>(other - heads.begin());
    return fmt::format("rank {} on {} sees {} there", rank, communicator.broadcast(host_name(), rank),
                       other->empty() ? "no checkpoint" : "another file");
}

std::optional<std::string> damage_of_schema(const std::string& path)
{
    const h5::File file    = h5::File::open_received(path);
    const auto     version = h5::read_numbers_attribute(file, "/", "schema_version");
    if (version.size() != 2) { return "its schema is none of this program's"; }
    if (version[0] == schema[0]) { return {}; }
    return fmt::format("its schema is {}.{}, and this program (schema {}.{}) is {}", version[0], version[1], schema[0],
                       schema[1], version[0] > schema[0] ? "older" : "newer: go on with the version that wrote it");
}

} // namespace

CheckpointWriter::CheckpointWriter(const Communicator& communicator, std::string path, std::int64_t expected)
    : communicator_(communicator)
    , path_(std::move(path))
{
    if (communicator.size() > 1)
    {
        on_root(communicator, [&] { require_space(path_, expected); });
    }
    file_.emplace(h5::File::create(temporary(path_), communicator, static_cast<hsize_t>(head_bytes)));
    h5::write_attribute(*file_, "/", "schema", std::string("tread-checkpoint"));
    h5::write_attribute(*file_, "/", "schema_version", std::vector<std::int64_t>(schema.begin(), schema.end()));
}

CheckpointWriter::~CheckpointWriter()
{
    file_.reset();
    if (!finished_ && communicator_.rank() == 0) { std::remove(temporary(path_).c_str()); }
}

template<class T>
void CheckpointWriter::write(const std::string& name, const std::vector<T>& values, int width)
{
    std::vector<std::int64_t> first{0};
    for (const std::int64_t count :
         communicator_.gather(static_cast<std::int64_t>(values.size() / static_cast<std::size_t>(width))))
    {
        first.push_back(first.back() + count);
    }
    const auto     rank = static_cast<std::size_t>(communicator_.rank());
    const auto     row  = [&](std::size_t r) { return static_cast<hsize_t>(first[r]); };
    const h5::Rows rows{row(first.size() - 1), row(rank), row(rank + 1) - row(rank)};
    // One rank's disk may be full: all stop here together, so that none waits in the next collective call.
    on_every_rank(communicator_,
                  [&]
                  {
                      h5::write(*file_, name, values, width, rows);
                      h5::write_attribute(*file_, name, first_rows, first);
                  });
}

template void CheckpointWriter::write(const std::string&, const std::vector<double>&, int);
template void CheckpointWriter::write(const std::string&, const std::vector<float>&, int);
template void CheckpointWriter::write(const std::string&, const std::vector<std::int32_t>&, int);
template void CheckpointWriter::write(const std::string&, const std::vector<std::int64_t>&, int);
template void CheckpointWriter::write(const std::string&, const std::vector<std::uint32_t>&, int);
template void CheckpointWriter::write(const std::string&, const std::vector<std::uint64_t>&, int);
template void CheckpointWriter::write(const std::string&, const std::vector<std::uint8_t>&, int);

void CheckpointWriter::text(const std::string& name, const std::string& value)
{
    h5::write_attribute(*file_, "/", name, value);
}

void CheckpointWriter::number(const std::string& name, std::int64_t value)
{
    h5::write_attribute(*file_, "/", name, std::vector<std::int64_t>{value});
}

/// Data written by a rank may be on its machine alone until that machine flushes them.
std::int64_t CheckpointWriter::finish()
{
    on_every_rank(communicator_, [&] { file_->close(); });
    file_.reset();
    Head head;
    on_every_rank(communicator_,
                  [&]
                  {
                      flush_to_disk(temporary(path_));
                      head.bytes = bytes_of(temporary(path_));
                  });
    head.checksum = checksum(communicator_, temporary(path_), head_bytes, head.bytes);
    on_root(communicator_,
            [&]
            {
                overwrite_start(temporary(path_), text_of(head));
                rename_file(temporary(path_), path_);
                flush_to_disk(std::filesystem::path(path_).parent_path().string());
            });
    finished_ = true;
    return head.bytes;
}

std::vector<std::int64_t> CheckpointReader::first_rows(const std::string& name) const
{
    std::vector<std::int64_t> first = h5::read_numbers_attribute(file_, name, io::first_rows);
    const std::int64_t        rows  = h5::count_rows(file_, name);
    if (first.size() > 1 && first.front() == 0 && first.back() == rows && std::is_sorted(first.begin(), first.end()))
    {
        return first;
    }
    throw EnvironmentError(fmt::format("{}: the checkpoint cannot be used: {} of {}: {}; accepted: numbers that ascend "
                                       "from 0 to {}, its rows",
                                       path(), io::first_rows, name, fmt::join(first, ", "), rows));
}

std::optional<std::string> damage_of(const Communicator& communicator, const std::string& path)
{
    try
    {
        std::string         found;
        std::optional<Head> head;
        on_root(communicator, [&] { found = irregularity(path).value_or(""); });
        found = communicator.broadcast(found);
        if (!found.empty()) { return found; }
        head = head_of(path);
        on_root(communicator, [&] { found = damage_of_head(path, head).value_or(""); });
        found = communicator.broadcast(found);
        if (found.empty()) { found = stranger(communicator, head); }
        if (!found.empty()) { return found; }
        if (checksum(communicator, path, head_bytes, head->bytes) != head->checksum)
        {
            return "its bytes have changed since it was written (checksum)";
        }
        const auto look = [&]
        {
            // Reads the whole structure and all texts, so that a damaged file crashes the child.
            found = run_in_child(path,
                                 [&]
                                 {
                                     auto damage = damage_of_schema(path);
                                     if (!damage) { describe_here(path); }
                                     return damage.value_or("");
                                 });
        };
        on_root(communicator, look);
        found = communicator.broadcast(found);
        return found.empty() ? std::nullopt : std::optional<std::string>(found);
    }
    catch (const Error& error)
    {
        return error.what();
    }
}

} // namespace tread::io
