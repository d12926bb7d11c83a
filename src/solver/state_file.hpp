#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "backend/array.hpp"
#include "io/checkpoint_file.hpp"

namespace tread::solver
{

/// What a loaded state can be.
enum class Fidelity
{
    exact,    ///< to the bit: what ranks hold, in the places where they had it, with every list that is still in use
    physical, ///< what the scene's state is; who holds it where, and lists, are made anew: it agrees to rounding
};

/// A state on its way into a checkpoint or out of it. Each part of a simulation lists what it holds once, in
/// transfer(), for both ways. Calls are collective and come in the same order on all ranks.
class StateFile
{
public:
    /// Into the file.
    StateFile(const Communicator& communicator, io::CheckpointWriter& writer, Fidelity fidelity)
        : communicator_(communicator)
        , writer_(&writer)
        , fidelity_(fidelity)
    {
    }

    /// Out of it.
    StateFile(const Communicator& communicator, const io::CheckpointReader& reader, Fidelity fidelity)
        : communicator_(communicator)
        , reader_(&reader)
        , fidelity_(fidelity)
    {
    }

    bool                loads() const { return reader_ != nullptr; }
    bool                exact() const { return fidelity_ == Fidelity::exact; }
    const Communicator& communicator() const { return communicator_; }

    /// Single numbers: integers, doubles, words of an enum, yes or no. Loaded from a rank's own, or from rank 0's where
    /// the state is not exact.
    template<class... T>
    void numbers(const std::string& name, T&... values)
    {
        std::vector<double> row{static_cast<double>(values)...};
        row_of_numbers(name, row);
        if (!loads()) { return; }
        std::size_t at = 0;
        ((values = static_cast<T>(row[at++])), ...);
    }

    /// A struct that holds doubles and nothing else; in the same way.
    template<class T>
    void doubles(const std::string& name, T& value)
    {
        static_assert(std::is_trivially_destructible_v<T> && sizeof(T) % sizeof(double) == 0);
        std::vector<double> row(sizeof(T) / sizeof(double));
        std::memcpy(row.data(), static_cast<const void*>(&value), sizeof(T));
        row_of_numbers(name, row);
        std::memcpy(static_cast<void*>(&value), row.data(), sizeof(T));
    }

    /// A text that all ranks have.
    void text(const std::string& name, std::string& value);

    /// Values of this rank, of the exact state only.
    template<class T>
    void own(const std::string& name, std::vector<T>& values)
    {
        if (loads()) { values = own_rows<T>(name); }
        else { write(name, values); }
    }
    template<class Exec, class T>
    void own(const std::string& name, Array<Exec, T>& array)
    {
        if (loads()) { array.assign(own_rows<T>(name)); }
        else { write(name, array.to_host()); }
    }

    /// Values that all ranks have: written by rank 0, read by all.
    template<class T>
    void common(const std::string& name, std::vector<T>& values)
    {
        if (loads()) { values = all_rows<T>(name); }
        else { write(name, communicator_.rank() == 0 ? values : std::vector<T>{}); }
    }
    template<class Exec, class T>
    void common(const std::string& name, Array<Exec, T>& array)
    {
        if (loads()) { array.assign(all_rows<T>(name)); }
        else { write(name, communicator_.rank() == 0 ? array.to_host() : std::vector<T>{}); }
    }

    /// Values of this rank. Loaded are its own, or all ranks' where the state is not exact.
    template<class T>
    void own_or_all(const std::string& name, std::vector<T>& values)
    {
        if (!loads()) { write(name, values); }
        else { values = exact() ? own_rows<T>(name) : all_rows<T>(name); }
    }

    /// One plane of `count` values of this rank. Loaded are its own, or an even share of all where the state is not
    /// exact: `share` says which.
    struct Share
    {
        std::int64_t first;
        std::int64_t count;
    };
    Share share(const std::string& name) const;
    template<class Exec, class T>
    void plane(const Exec& exec, const std::string& name, T* data, const Share& rows)
    {
        const auto count = static_cast<std::size_t>(rows.count);
        if (loads())
        {
            const std::vector<T> values = read<T>(name, rows.first, rows.count);
            copy_from_host(exec, data, values.data(), count * sizeof(T));
            return;
        }
        std::vector<T>& values = std::get<std::vector<T>>(planes_);
        values.resize(count);
        copy_to_host(exec, values.data(), data, count * sizeof(T));
        write(name, values);
    }

private:
    /// Numbers as themselves; structs, which hold doubles, as rows of these.
    template<class T>
    using Word = std::conditional_t<std::is_arithmetic_v<T>, T, double>;
    template<class T>
    static constexpr int width = sizeof(T) / sizeof(Word<T>);

    void row_of_numbers(const std::string& name, std::vector<double>& row);

    template<class T>
    void write(const std::string& name, const std::vector<T>& values)
    {
        static_assert(std::is_trivially_destructible_v<T> && sizeof(T) % sizeof(Word<T>) == 0);
        if constexpr (std::is_arithmetic_v<T>) { writer_->write(name, values, 1); }
        else
        {
            std::vector<Word<T>> words(values.size() * width<T>);
            if (!values.empty())
            {
                std::memcpy(words.data(), static_cast<const void*>(values.data()), values.size() * sizeof(T));
            }
            writer_->write(name, words, width<T>);
        }
    }

    template<class T>
    std::vector<T> read(const std::string& name, std::int64_t first, std::int64_t count) const
    {
        const std::vector<Word<T>> words = reader_->read<Word<T>>(name, width<T>, first, count);
        std::vector<T>             values(static_cast<std::size_t>(count));
        if (count > 0) { std::memcpy(static_cast<void*>(values.data()), words.data(), values.size() * sizeof(T)); }
        return values;
    }

    template<class T>
    std::vector<T> own_rows(const std::string& name) const
    {
        const auto first = reader_->first_rows(name);
        const auto rank  = static_cast<std::size_t>(communicator_.rank());
        return read<T>(name, first.at(rank), first.at(rank + 1) - first.at(rank));
    }

    template<class T>
    std::vector<T> all_rows(const std::string& name) const
    {
        return read<T>(name, 0, reader_->first_rows(name).back());
    }

    const Communicator&         communicator_;
    io::CheckpointWriter*       writer_ = nullptr;
    const io::CheckpointReader* reader_ = nullptr;
    Fidelity                    fidelity_;

    /// Planes on their way: memory that is new costs more than what is put into it.
    std::tuple<std::vector<double>, std::vector<float>, std::vector<std::uint32_t>, std::vector<std::uint8_t>> planes_;
};

} // namespace tread::solver
