#include "io/checksum.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "base/errors.hpp"

namespace tread::io
{
namespace
{

constexpr std::int64_t  block_bytes = std::int64_t{4} << 20;
constexpr std::uint64_t start = 0xcbf29ce484222325u, prime = 0x100000001b3u;

std::uint64_t step(std::uint64_t sum, std::uint64_t word) { return (sum ^ word) * prime; }

/// Bytes after the last whole word count as a word padded with zeros, followed by their number.
std::uint64_t sum_of(const std::vector<char>& bytes, std::size_t count)
{
    std::uint64_t sum = step(start, count);
    for (std::size_t at = 0; at < count; at += sizeof(std::uint64_t))
    {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes.data() + at, std::min(sizeof(word), count - at));
        sum = step(sum, word);
    }
    return sum;
}

/// An open file.
class Input
{
public:
    explicit Input(const std::string& path)
        : path_(path)
        , id_(open(path.c_str(), O_RDONLY))
    {
        if (id_ < 0) { fail(std::strerror(errno)); }
    }
    ~Input() { close(id_); }
    Input(const Input&)            = delete;
    Input& operator=(const Input&) = delete;

    void read(std::int64_t first, std::size_t count, std::vector<char>& to) const
    {
        for (std::size_t done = 0; done < count;)
        {
            const auto got = pread(id_, to.data() + done, count - done, first + static_cast<std::int64_t>(done));
            if (got < 0 && errno == EINTR) { continue; }
            if (got <= 0) { fail(got < 0 ? std::strerror(errno) : "it is shorter than it should be"); }
            done += static_cast<std::size_t>(got);
        }
    }

private:
    [[noreturn]] void fail(const char* why) const
    {
        throw EnvironmentError(fmt::format("{}: cannot be read: {}", path_, why));
    }

    std::string path_;
    int         id_;
};

/// Checksums of the blocks from `begin` on, up to `last`; computed by threads in parallel.
std::vector<std::uint64_t> sums_of_blocks(const Input& input, std::int64_t first, std::int64_t end, std::int64_t begin,
                                          std::int64_t last)
{
    std::vector<std::uint64_t> sums(static_cast<std::size_t>(last - begin));
    std::exception_ptr         failed;
#pragma omp parallel
    {
        std::vector<char> bytes(static_cast<std::size_t>(block_bytes));
#pragma omp for
        for (std::int64_t block = begin; block < last; ++block)
        {
            try
            {
                const std::int64_t at    = first + block * block_bytes;
                const auto         count = static_cast<std::size_t>(std::min(block_bytes, end - at));
                input.read(at, count, bytes);
                sums[static_cast<std::size_t>(block - begin)] = sum_of(bytes, count);
            }
            catch (const EnvironmentError&)
            {
#pragma omp critical
                failed = std::current_exception();
            }
        }
    }
    if (failed) { std::rethrow_exception(failed); }
    return sums;
}

} // namespace

std::uint64_t checksum(const Communicator& communicator, const std::string& path, std::int64_t first, std::int64_t end)
{
    const std::int64_t blocks = (end - first + block_bytes - 1) / block_bytes, ranks = communicator.size();
    const std::int64_t begin = blocks * communicator.rank() / ranks, last = blocks * (communicator.rank() + 1) / ranks;
    std::vector<std::uint64_t> own;
    on_every_rank(communicator, [&] { own = sums_of_blocks(Input(path), first, end, begin, last); });
    std::uint64_t sum = start;
    for (const std::uint64_t block : communicator.gather(own)) { sum = step(sum, block); }
    return sum;
}

} // namespace tread::io
