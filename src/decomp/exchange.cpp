#include "decomp/exchange.hpp"
#include "backend/instantiate.hpp"

#include <utility>

namespace tread::decomp
{
namespace
{

std::int64_t rows_of(const std::vector<Route>& routes)
{
    std::int64_t rows = 0;
    for (const Route& route : routes) { rows += route.rows; }
    return rows;
}

/// Byte ranges of the routes in a packed buffer.
void write_ranges(const std::vector<Route>& routes, std::int64_t row_bytes, MessageRanges& ranges)
{
    ranges.clear();
    std::int64_t first = 0;
    for (const Route& route : routes)
    {
        ranges.push_back({route.rank, first, route.rows * row_bytes});
        first += route.rows * row_bytes;
    }
}

/// Routes by which other ranks send to this one.
std::vector<Route> announced(const Communicator& communicator, const std::vector<Route>& to)
{
    std::vector<std::int64_t> rows(static_cast<std::size_t>(communicator.size()), 0);
    for (const Route& route : to) { rows[static_cast<std::size_t>(route.rank)] = route.rows; }
    std::vector<Route> from;
    int                rank = 0;
    for (const std::int64_t count : communicator.all_to_all(rows))
    {
        if (count > 0) { from.push_back({rank, count}); }
        ++rank;
    }
    return from;
}

} // namespace

template<class Exec>
Exchange<Exec>::Exchange(Transport<Exec>& transport, const char* name)
    : Exchange(transport, transport.exec(), name)
{
}

template<class Exec>
Exchange<Exec>::Exchange(Transport<Exec>& transport, const Exec& exec, const char* name)
    : transport_(&transport)
    , exec_(exec)
    , messages_(transport, exec, name)
    , rows_(exec, name)
{
}

template<class Exec>
void Exchange<Exec>::plan(const std::vector<std::vector<std::int32_t>>& rows_to)
{
    std::vector<std::int32_t> rows;
    std::vector<Route>        to;
    for (std::size_t rank = 0; rank < rows_to.size(); ++rank)
    {
        if (rows_to[rank].empty()) { continue; }
        rows.insert(rows.end(), rows_to[rank].begin(), rows_to[rank].end());
        to.push_back({static_cast<int>(rank), static_cast<std::int64_t>(rows_to[rank].size())});
    }
    std::vector<Route> from = announced(transport_->communicator(), to);
    plan(rows, std::move(to), std::move(from));
}

template<class Exec>
void Exchange<Exec>::plan(const std::vector<std::int32_t>& rows, std::vector<Route> to, std::vector<Route> from)
{
    rows_.assign(rows);
    to_       = std::move(to);
    from_     = std::move(from);
    received_ = rows_of(from_);
    messages_.count_anew();
}

template<class Exec>
void Exchange<Exec>::begin(const Columns& columns)
{
    const std::int64_t row_bytes = 4 * std::int64_t{columns.words};
    write_ranges(to_, row_bytes, out_);
    write_ranges(from_, row_bytes, in_);
    auto* going = reinterpret_cast<std::uint32_t*>(messages_.outgoing(sent() * row_bytes));
    arriving_   = reinterpret_cast<const std::uint32_t*>(messages_.incoming(received_ * row_bytes));
    pack_rows(exec_, columns, rows_.data(), sent(), going);
    messages_.start(out_, in_);
}

template<class Exec>
void Exchange<Exec>::finish(const Columns& columns, std::int64_t first)
{
    finish(columns, nullptr, first);
}

template<class Exec>
void Exchange<Exec>::finish(const Columns& columns, const Array<Exec, std::int32_t>& rows)
{
    finish(columns, rows.data(), 0);
}

template<class Exec>
const std::byte* Exchange<Exec>::finish()
{
    messages_.finish();
    return reinterpret_cast<const std::byte*>(arriving_);
}

template<class Exec>
void Exchange<Exec>::finish(const Columns& columns, const std::int32_t* index, std::int64_t first)
{
    messages_.finish();
    unpack_rows(exec_, arriving_, received_, columns, index, first);
}

#define TREAD_INSTANTIATE(Exec) template class Exchange<Exec>
TREAD_FOR_BACKENDS(TREAD_INSTANTIATE)
#undef TREAD_INSTANTIATE

} // namespace tread::decomp
