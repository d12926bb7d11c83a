#include "decomp/messages.hpp"

#include <cstdint>
#include <limits>

#include <fmt/format.h>

namespace tread::decomp
{
namespace
{

/// Offset of each message in bytes, and the end of the last.
std::vector<int> places_of(const std::vector<int>& bytes)
{
    std::vector<int> places{0};
    for (const int count : bytes) { places.push_back(places.back() + count); }
    return places;
}

int checked(std::int64_t bytes)
{
    if (bytes > std::numeric_limits<int>::max() / 2)
    {
        throw EnvironmentError(fmt::format("a message of {} bytes between ranks: more ranks, or fewer bodies", bytes));
    }
    return static_cast<int>(bytes);
}

} // namespace

std::vector<Message> exchange_messages(const Communicator& communicator, const std::vector<Message>& messages)
{
    std::vector<std::int64_t> sent;
    Message                   out;
    for (const Message& message : messages)
    {
        sent.push_back(static_cast<std::int64_t>(message.size()));
        out.insert(out.end(), message.begin(), message.end());
    }
    checked(static_cast<std::int64_t>(out.size()));
    std::vector<int> to, from;
    for (const std::int64_t bytes : sent) { to.push_back(checked(bytes)); }
    for (const std::int64_t bytes : communicator.all_to_all(sent)) { from.push_back(checked(bytes)); }
    const std::vector<int> to_place = places_of(to), from_place = places_of(from);
    Message                in(static_cast<std::size_t>(from_place.back()));
    const Waiting          wait(communicator.waits(), "all-to-all");
    check_mpi(MPI_Alltoallv(out.data(), to.data(), to_place.data(), MPI_BYTE, in.data(), from.data(), from_place.data(),
                            MPI_BYTE, communicator.native()),
              "all-to-all of messages");
    std::vector<Message> found;
    for (std::size_t r = 0; r < from.size(); ++r)
    {
        found.emplace_back(in.begin() + from_place[r], in.begin() + from_place[r + 1]);
    }
    return found;
}

} // namespace tread::decomp
