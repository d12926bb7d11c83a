#include "solver/state_file.hpp"

namespace tread::solver
{

void StateFile::row_of_numbers(const std::string& name, std::vector<double>& row)
{
    const auto columns = static_cast<int>(row.size());
    if (!loads())
    {
        writer_->write(name, row, columns);
        return;
    }
    row = reader_->read<double>(name, columns, exact() ? communicator_.rank() : 0, 1);
}

void StateFile::text(const std::string& name, std::string& value)
{
    if (loads()) { value = reader_->text(name); }
    else { writer_->text(name, communicator_.broadcast(value)); } // as rank 0 has it
}

StateFile::Share StateFile::share(const std::string& name) const
{
    const std::vector<std::int64_t> first = reader_->first_rows(name);
    const std::int64_t              rank = communicator_.rank(), ranks = communicator_.size();
    if (exact())
    {
        const std::int64_t begin = first.at(static_cast<std::size_t>(rank));
        return {begin, first.at(static_cast<std::size_t>(rank) + 1) - begin};
    }
    const std::int64_t begin = first.back() * rank / ranks;
    return {begin, first.back() * (rank + 1) / ranks - begin};
}

} // namespace tread::solver
