#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>

namespace tread
{

/// Counts a run's launches and allocations by name; tests use it to check that a scene runs only what it needs.
class Counters
{
public:
    void launched(std::string_view name) { ++entry(launches_, name); }

    void allocated(std::string_view name, std::int64_t bytes)
    {
        entry(bytes_, name) += bytes;
        current_ += bytes;
        if (current_ > peak_) { peak_ = current_; }
    }

    void freed(std::string_view name, std::int64_t bytes)
    {
        entry(bytes_, name) -= bytes;
        current_ -= bytes;
    }

    /// Sets the estimated memory of the whole run, bytes, for the message of a failed allocation; 0 = unknown.
    void         expect(std::int64_t bytes) { expected_ = bytes; }
    std::int64_t expected_bytes() const { return expected_; }

    /// Sets the limit of the total, bytes: an allocation beyond it fails as if the memory were full.
    void limit(std::int64_t bytes) { limit_ = bytes; }
    bool has_room(std::int64_t bytes) const { return bytes <= limit_ - current_; }

    std::int64_t current_bytes() const { return current_; }
    std::int64_t peak_bytes() const { return peak_; }

    /// Number of launches by kernel name.
    const std::map<std::string, std::int64_t, std::less<>>& launches() const { return launches_; }

    /// Bytes held now by array name; an array that was ever allocated keeps its row.
    const std::map<std::string, std::int64_t, std::less<>>& bytes() const { return bytes_; }

private:
    using Table = std::map<std::string, std::int64_t, std::less<>>;

    static std::int64_t& entry(Table& table, std::string_view name)
    {
        auto at = table.find(name);
        if (at == table.end()) { at = table.emplace(std::string(name), 0).first; }
        return at->second;
    }

    Table        launches_;
    Table        bytes_;
    std::int64_t current_  = 0;
    std::int64_t peak_     = 0;
    std::int64_t expected_ = 0;
    std::int64_t limit_    = std::numeric_limits<std::int64_t>::max();
};

} // namespace tread
