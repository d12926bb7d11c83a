#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "backend/array.hpp"
#include "io/accept.hpp"
#include "io/checkpoint_file.hpp"

namespace tread::solver
{

namespace accept = io::accept;

/// How closely a loaded state matches the saved one.
enum class Fidelity
{
    exact,    ///< bitwise: each rank gets its own arrays in their order, with all lists in use
    physical, ///< the scene's state; distribution and lists are rebuilt, so it agrees to rounding
};

/// A state being saved to a checkpoint or loaded from it. Each part of a simulation lists its data once, in
/// transfer(), for both directions. Calls are collective and come in the same order on all ranks.
class StateFile
{
public:
    /// Opens for saving.
    StateFile(const Communicator& communicator, io::CheckpointWriter& writer, Fidelity fidelity)
        : communicator_(communicator)
        , writer_(&writer)
        , fidelity_(fidelity)
    {
    }

    /// Opens for loading.
    StateFile(const Communicator& communicator, const io::CheckpointReader& reader, Fidelity fidelity)
        : communicator_(communicator)
        , reader_(&reader)
        , fidelity_(fidelity)
    {
    }

    bool                loads() const { return reader_ != nullptr; }
    bool                exact() const { return fidelity_ == Fidelity::exact; }
    const Communicator& communicator() const { return communicator_; }

    /// Transfers single numbers: integers, doubles, booleans; with a range (accept::number) where their type admits
    /// more values than they may have. Loads the rank's own values, or rank 0's where the state is not exact.
    template<class... T>
    void numbers(const std::string& name, T&&... values)
    {
        numbers_within(name, accept::by_type(values)...);
    }

    /// Transfers a struct that holds doubles only, like numbers().
    template<class T>
    void doubles(const std::string& name, T& value)
    {
        static_assert(std::is_trivially_destructible_v<T> && sizeof(T) % sizeof(double) == 0);
        std::vector<double> row(sizeof(T) / sizeof(double));
        std::memcpy(row.data(), static_cast<const void*>(&value), sizeof(T));
        row_of_numbers(name, row, std::vector<NumberRange>(row.size(), {-accept::largest, accept::largest, false}));
        std::memcpy(static_cast<void*>(&value), row.data(), sizeof(T));
    }

    /// Transfers a text that is the same on all ranks.
    void text(const std::string& name, std::string& value);

    // The functions below take a bound of accept.hpp that loaded values must satisfy; else EnvironmentError with file,
    // data set, value and accepted range, on all ranks.

    /// Transfers values of this rank; exact state only.
    template<class T, class Bound>
    void own(const std::string& name, std::vector<T>& values, const Bound& accepted)
    {
        if (loads()) { values = own_rows<T>(name, accepted); }
        else { write(name, values); }
    }
    template<class Exec, class T, class Bound>
    void own(const std::string& name, Array<Exec, T>& array, const Bound& accepted)
    {
        if (loads()) { array.assign(own_rows<T>(name, accepted)); }
        else { write(name, array.to_host()); }
    }

    /// Transfers values that all ranks have: rank 0 writes, all read.
    template<class T, class Bound>
    void common(const std::string& name, std::vector<T>& values, const Bound& accepted)
    {
        if (loads()) { values = all_rows<T>(name, accepted); }
        else { write(name, communicator_.rank() == 0 ? values : std::vector<T>{}); }
    }
    template<class Exec, class T, class Bound>
    void common(const std::string& name, Array<Exec, T>& array, const Bound& accepted)
    {
        if (loads()) { array.assign(all_rows<T>(name, accepted)); }
        else { write(name, communicator_.rank() == 0 ? array.to_host() : std::vector<T>{}); }
    }

    /// Transfers values of which each rank writes a part, one after the other; all ranks load all.
    template<class T, class Bound>
    void parts(const std::string& name, std::vector<T>& values, const Bound& accepted)
    {
        if (loads()) { values = all_rows<T>(name, accepted); }
        else { write(name, values); }
    }

    /// Transfers values of this rank. Loads its own, or all ranks' where the state is not exact.
    template<class T, class Bound>
    void own_or_all(const std::string& name, std::vector<T>& values, const Bound& accepted)
    {
        if (!loads()) { write(name, values); }
        else { values = exact() ? own_rows<T>(name, accepted) : all_rows<T>(name, accepted); }
    }

    /// Transfers one plane of `count` values of this rank. Loads its own, or an even share of all where the state is
    /// not exact. share() returns the range of rows of a data set, which has at most `most` rows.
    struct Share
    {
        std::int64_t first;
        std::int64_t count;
        std::int64_t total;
    };
    Share share(const std::string& name, std::size_t most) const;
    template<class Exec, class T, class Bound>
    void plane(const Exec& exec, const std::string& name, T* data, const Share& rows, const Bound& accepted)
    {
        const auto count = static_cast<std::size_t>(rows.count);
        if (loads())
        {
            const std::vector<T> values = checked<T>(name, rows, accepted);
            copy_from_host(exec, data, values.data(), count * sizeof(T));
            return;
        }
        std::vector<T>& values = std::get<std::vector<T>>(planes_);
        values.resize(count);
        copy_to_host(exec, values.data(), data, count * sizeof(T));
        write(name, values);
    }

    /// Ends loading with an error about a data set.
    [[noreturn]] void refuse(const std::string& name, const accept::Refusal& refusal) const;

private:
    template<class T>
    using Word = accept::Word<T>;
    template<class T>
    static constexpr int width = static_cast<int>(accept::words<T>);

    struct NumberRange
    {
        double low, high;
        bool   whole;
    };

    template<class... T>
    void numbers_within(const std::string& name, accept::Bounded<T>... values)
    {
        std::vector<double> row{static_cast<double>(values.value)...};
        row_of_numbers(name, row, {{values.low, values.high, !std::is_floating_point_v<T>}...});
        if (!loads()) { return; }
        std::size_t at = 0;
        ((values.value = static_cast<T>(row[at++])), ...);
    }

    void row_of_numbers(const std::string& name, std::vector<double>& row, const std::vector<NumberRange>& ranges);

    template<class T>
    void write(const std::string& name, const std::vector<T>& values)
    {
        static_assert(std::is_trivially_destructible_v<T> && sizeof(T) % sizeof(Word<T>) == 0);
        if constexpr (std::is_arithmetic_v<T>) { writer_->write(name, values, 1); }
        else
        {
            std::vector<Word<T>> words(values.size() * accept::words<T>);
            if (!values.empty())
            {
                std::memcpy(words.data(), static_cast<const void*>(values.data()), values.size() * sizeof(T));
            }
            writer_->write(name, words, width<T>);
        }
    }

    template<class T>
    std::vector<T> read(const std::string& name, const Share& rows) const
    {
        const std::vector<Word<T>> words = reader_->read<Word<T>>(name, width<T>, rows.first, rows.count);
        std::vector<T>             values(static_cast<std::size_t>(rows.count));
        if (rows.count > 0) { std::memcpy(static_cast<void*>(values.data()), words.data(), values.size() * sizeof(T)); }
        return values;
    }

    /// Reads and checks; an error on one rank is thrown on all.
    template<class T, class Bound>
    std::vector<T> checked(const std::string& name, const Share& rows, const Bound& accepted) const
    {
        std::vector<T> values;
        on_every_rank(communicator_,
                      [&]
                      {
                          require_total(name, rows);
                          values = read<T>(name, rows);
                          if (const accept::Verdict refusal = accepted(values)) { refuse(name, *refusal); }
                      });
        return values;
    }

    template<class T, class Bound>
    std::vector<T> own_rows(const std::string& name, const Bound& accepted) const
    {
        return checked<T>(name, rows_of_rank(name), accepted);
    }

    template<class T, class Bound>
    std::vector<T> all_rows(const std::string& name, const Bound& accepted) const
    {
        return checked<T>(name, all_of(name), accepted);
    }

    Share rows_of_rank(const std::string& name) const;
    Share all_of(const std::string& name) const;
    void  require_a_row_each(const std::string& name) const;
    void  require_total(const std::string& name, const Share& rows) const;

    const Communicator&         communicator_;
    io::CheckpointWriter*       writer_ = nullptr;
    const io::CheckpointReader* reader_ = nullptr;
    Fidelity                    fidelity_;

    /// Staging buffers for planes; reused, since the first touch of new memory faults pages in.
    std::tuple<std::vector<double>, std::vector<float>, std::vector<std::uint32_t>, std::vector<std::uint8_t>> planes_;
};

} // namespace tread::solver
