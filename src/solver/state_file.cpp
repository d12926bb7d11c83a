#include "solver/state_file.hpp"

#include <cmath>

#include <fmt/format.h>

#include "base/errors.hpp"

namespace tread::solver
{

void StateFile::row_of_numbers(const std::string& name, std::vector<double>& row,
                               const std::vector<NumberRange>& ranges)
{
    const auto columns = static_cast<int>(row.size());
    if (!loads())
    {
        writer_->write(name, row, columns);
        return;
    }
    const auto read = [&]
    {
        require_a_row_each(name);
        row = reader_->read<double>(name, columns, exact() ? communicator_.rank() : 0, 1);
        for (std::size_t i = 0; i < row.size(); ++i)
        {
            const auto& [low, high, whole] = ranges[i];
            if (low <= row[i] && row[i] <= high && (!whole || row[i] == std::floor(row[i]))) { continue; }
            refuse(name, {-1, fmt::format("number {} is {}", i + 1, row[i]),
                          fmt::format("{} from {} to {}", whole ? "a whole number" : "a number", low, high)});
        }
    };
    on_every_rank(communicator_, read);
}

/// Checks that every rank has written one row.
void StateFile::require_a_row_each(const std::string& name) const
{
    const std::vector<std::int64_t> first = reader_->first_rows(name);
    const auto                      ranks = static_cast<std::int64_t>(first.size()) - 1;
    for (std::int64_t rank = 0; rank < ranks; ++rank)
    {
        const auto own = first[static_cast<std::size_t>(rank) + 1] - first[static_cast<std::size_t>(rank)];
        if (own != 1) { refuse(name, {-1, fmt::format("{} rows of rank {}", own, rank), "1"}); }
    }
    if (exact() && ranks != communicator_.size())
    {
        refuse(name, {-1, fmt::format("rows of {} ranks", ranks), fmt::format("of {}", communicator_.size())});
    }
}

void StateFile::text(const std::string& name, std::string& value)
{
    if (loads())
    {
        on_every_rank(communicator_, [&] { value = reader_->text(name); });
    }
    else { writer_->text(name, communicator_.broadcast(value)); } // rank 0's value
}

void StateFile::refuse(const std::string& name, const accept::Refusal& refusal) const
{
    const std::string row = refusal.row < 0 ? "" : fmt::format(" row {}", refusal.row);
    throw EnvironmentError(fmt::format("{}: the checkpoint cannot be used: {}{}: {}; accepted: {}", reader_->path(),
                                       name, row, refusal.value, refusal.accepted));
}

StateFile::Share StateFile::rows_of_rank(const std::string& name) const
{
    Share      rows{0, 0, 0};
    const auto find = [&]
    {
        const std::vector<std::int64_t> first = reader_->first_rows(name);
        const auto                      rank  = static_cast<std::size_t>(communicator_.rank());
        if (first.size() != static_cast<std::size_t>(communicator_.size()) + 1)
        {
            refuse(name,
                   {-1, fmt::format("rows of {} ranks", first.size() - 1), fmt::format("of {}", communicator_.size())});
        }
        rows = {first[rank], first[rank + 1] - first[rank], first.back()};
    };
    on_every_rank(communicator_, find);
    return rows;
}

StateFile::Share StateFile::all_of(const std::string& name) const
{
    Share rows{0, 0, 0};
    on_every_rank(communicator_, [&] { rows.total = reader_->first_rows(name).back(); });
    return {0, rows.total, rows.total};
}

void StateFile::require_total(const std::string& name, const Share& rows) const
{
    const std::int64_t total = reader_->first_rows(name).back();
    if (total == rows.total) { return; }
    refuse(name, {-1, fmt::format("{} rows", total), fmt::format("{}, as of what stands beside it", rows.total)});
}

StateFile::Share StateFile::share(const std::string& name, std::size_t most) const
{
    const Share rows = exact() ? rows_of_rank(name) : all_of(name);
    if (rows.total > static_cast<std::int64_t>(most))
    {
        refuse(name, {-1, fmt::format("{} rows", rows.total), fmt::format("at most {}", most)});
    }
    if (exact()) { return rows; }
    const std::int64_t rank = communicator_.rank(), ranks = communicator_.size();
    const std::int64_t begin = rows.total * rank / ranks;
    return {begin, rows.total * (rank + 1) / ranks - begin, rows.total};
}

} // namespace tread::solver
