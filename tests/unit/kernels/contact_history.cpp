#include <algorithm>
#include <cstring>
#include <random>
#include <unordered_set>

#include <omp.h>

#include "backend.hpp"
#include "kernels/contact/history_kern.hpp"

// Hash table of the contact history.
namespace tread::test
{
namespace
{

using contact::HistoryRecord;

template<class Exec>
class ContactHistory : public BackendTest<Exec>
{
};
TYPED_TEST_SUITE(ContactHistory, Backends, BackendNames);

/// A record unique to its key.
HistoryRecord record_of(std::uint64_t key)
{
    const double low = static_cast<double>(key & 0xffffffffU), high = static_cast<double>(key >> 32);
    return {key, {{low, high, 1.5 * low}, {0.5 * high, low + high, -high}, low - high}};
}

bool same(const contact::Tangential& a, const contact::Tangential& b) { return std::memcmp(&a, &b, sizeof(a)) == 0; }

std::vector<HistoryRecord> records_of(const std::vector<std::uint64_t>& keys)
{
    std::vector<HistoryRecord> records;
    records.reserve(keys.size());
    for (const std::uint64_t key : keys) { records.push_back(record_of(key)); }
    return records;
}

std::vector<std::uint64_t> random_keys(std::size_t count, unsigned seed)
{
    std::mt19937_64                   random(seed);
    std::unordered_set<std::uint64_t> found;
    while (found.size() < count)
    {
        if (const std::uint64_t key = random(); key != 0) { found.insert(key); }
    }
    return {found.begin(), found.end()};
}

/// Keys whose search begins at the given bin of a table for that many records.
std::vector<std::uint64_t> colliding_keys(std::size_t count, std::int64_t bins, std::int64_t home)
{
    std::vector<std::uint64_t> keys;
    for (std::uint64_t key = 1; keys.size() < count; ++key)
    {
        if (contact::home_bin(key, bins) == home) { keys.push_back(key); }
    }
    return keys;
}

/// A table in the backend's memory, and its lookups on the host.
template<class Exec>
class Table
{
public:
    explicit Table(const Exec& exec)
        : exec_(exec)
        , history_(exec)
    {
    }

    void fill(const std::vector<HistoryRecord>& records)
    {
        put_back(exec_, history_, records);
        bin_key_    = history_.bin_key.to_host();
        bin_record_ = history_.bin_record.to_host();
        tangential_ = history_.tangential.to_host();
    }

    contact::Tangential recall(std::uint64_t key)
    {
        return contact::recall({bins(), bin_key_.data(), bin_record_.data(), tangential_.data()}, key);
    }

    std::int64_t                      bins() const { return static_cast<std::int64_t>(bin_key_.size()); }
    const std::vector<std::uint64_t>& bin_key() const { return bin_key_; }
    std::vector<HistoryRecord>        read_out() const { return contact::read_out(history_); }

private:
    Exec                             exec_;
    contact::History<Exec>           history_;
    std::vector<std::uint64_t>       bin_key_;
    std::vector<std::int32_t>        bin_record_;
    std::vector<contact::Tangential> tangential_;
};

/// Every key finds its record, other keys find none, and the read-out is the sorted map of the records.
template<class Exec>
void expect_as_a_map(Table<Exec>& table, std::vector<std::uint64_t> keys, const std::vector<std::uint64_t>& others)
{
    std::size_t wrong = 0;
    for (const std::uint64_t key : keys) { wrong += !same(table.recall(key), record_of(key).tangential); }
    EXPECT_EQ(wrong, 0u) << "of " << keys.size();
    for (const std::uint64_t key : others) { wrong += !same(table.recall(key), contact::no_tangential()); }
    EXPECT_EQ(wrong, 0u) << "of " << others.size() << " keys without a record";

    std::sort(keys.begin(), keys.end());
    const auto records = table.read_out();
    ASSERT_EQ(records.size(), keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i)
    {
        ASSERT_EQ(records[i].key, keys[i]);
        ASSERT_TRUE(same(records[i].tangential, record_of(keys[i]).tangential));
    }
}

TYPED_TEST(ContactHistory, FindsWhatASortedMapFinds)
{
    for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{1000}, std::size_t{1000000}})
    {
        auto                             keys = random_keys(2 * count, 5);
        const std::vector<std::uint64_t> others(keys.begin() + static_cast<std::ptrdiff_t>(count), keys.end());
        keys.resize(count);
        Table<TypeParam> table(this->exec());
        table.fill(records_of(keys));
        expect_as_a_map(table, keys, others);
        EXPECT_GE(table.bins(), static_cast<std::int64_t>(2 * count)) << "half of the bins are empty";
    }
}

TYPED_TEST(ContactHistory, NeighboursInASceneSpreadOverTheBins)
{
    // 100 bodies with 1000 points each, with consecutive ids: probes of linear probing at half load, D. Knuth, The Art
    // of Computer Programming 3, section 6.4: (1 + 1/(1 - load)) / 2 per key found; three standard errors of the mean
    // are far less than the tenth allowed.
    std::vector<std::uint64_t> keys;
    for (int body = 0; body < 100; ++body)
    {
        for (std::uint32_t point = 0; point < 1000; ++point)
        {
            keys.push_back(contact::history_key(body, 20 * static_cast<std::uint32_t>(body) + point));
        }
    }
    Table<TypeParam> table(this->exec());
    table.fill(records_of(keys));
    std::int64_t probes = 0;
    for (const std::uint64_t key : keys)
    {
        std::int64_t bin = contact::home_bin(key, table.bins());
        for (++probes; table.bin_key()[static_cast<std::size_t>(bin)] != key; ++probes)
        {
            bin = contact::next_bin(bin, table.bins());
        }
    }
    const double load     = static_cast<double>(keys.size()) / static_cast<double>(table.bins());
    const double expected = 0.5 * (1 + 1 / (1 - load));
    const double measured = static_cast<double>(probes) / static_cast<double>(keys.size());
    std::printf("[ measured ] probes a key %.4f, expected %.4f at load %.3f, tolerance 10 %%\n", measured, expected,
                load);
    EXPECT_NEAR(measured, expected, 0.1 * expected);
}

TYPED_TEST(ContactHistory, CrowdedBinOverflowsAcrossTheEnd)
{
    constexpr std::int64_t bins = 1024;
    for (const std::int64_t home : {std::int64_t{0}, bins / 2, bins - 1, bins - 200})
    {
        auto                             keys = colliding_keys(700, bins, home);
        const std::vector<std::uint64_t> others(keys.begin() + 500, keys.end());
        keys.resize(500);
        Table<TypeParam> table(this->exec());
        table.fill(records_of(keys));
        ASSERT_EQ(table.bins(), bins);
        expect_as_a_map(table, keys, others);
    }
}

TYPED_TEST(ContactHistory, GrowsAndShrinksWithoutLosingARecord)
{
    Table<TypeParam> table(this->exec());
    for (const std::size_t count : {10, 1000, 100000, 5, 0, 3000})
    {
        const auto keys = random_keys(count, static_cast<unsigned>(count));
        table.fill(records_of(keys));
        expect_as_a_map(table, keys, {1, 2, 3});
    }
}

TYPED_TEST(ContactHistory, OrderAndThreadsOfTheInsertionDoNotShow)
{
    std::mt19937 random(3);
    auto         keys   = random_keys(100000, 8);
    const int    wanted = omp_get_max_threads();
    for (const int threads : {1, 2, 3})
    {
        omp_set_num_threads(threads);
        Table<TypeParam> table(this->exec());
        table.fill(records_of(keys));
        expect_as_a_map(table, keys, {});
        std::shuffle(keys.begin(), keys.end(), random);
    }
    omp_set_num_threads(wanted);
}

TYPED_TEST(ContactHistory, WithoutRecordsHoldsNoMemory)
{
    contact::History<TypeParam> history(this->exec());
    put_back(this->exec(), history, {});
    EXPECT_EQ(this->counters.current_bytes(), 0);
    EXPECT_TRUE(this->counters.launches().empty());
    EXPECT_TRUE(read_out(history).empty());
}

TYPED_TEST(ContactHistory, RecordsFollowTheirPoints)
{
    const TypeParam            exec = this->exec();
    std::vector<std::uint64_t> keys;
    for (std::int32_t body = 0; body < 3; ++body)
    {
        for (std::uint32_t point = 0; point < 1000; point += 1 + static_cast<std::uint32_t>(body))
        {
            keys.push_back(contact::history_key(body, point, static_cast<int>(point % 3)));
        }
    }
    contact::History<TypeParam> here(exec), there(exec);
    put_back(exec, here, records_of(keys));
    put_back(exec, there, records_of({contact::history_key(1, 5000)}));
    const std::vector<HistoryRecord> leaving = records_of(exec, here, {6, 7, 500, 4000});
    // 6 touches all three bodies, 7 the first, 500 the first two.
    EXPECT_EQ(leaving.size(), 3U + 1U + 2U);
    for (const HistoryRecord& record : leaving)
    {
        const std::uint32_t point = contact::point_of(record.key);
        EXPECT_TRUE(point == 6 || point == 7 || point == 500);
        EXPECT_TRUE(same(record.tangential, record_of(record.key).tangential));
    }
    add_records(exec, there, leaving);
    EXPECT_EQ(read_out(there).size(), 7U);
    for (const HistoryRecord& record : read_out(there))
    {
        EXPECT_TRUE(same(record.tangential, record_of(record.key).tangential));
    }
    EXPECT_TRUE(records_of(exec, here, {}).empty());
}

TEST(ContactHistoryKey, PairsAndSamplesDiffer)
{
    std::unordered_set<std::uint64_t> keys;
    const std::int32_t                last = (1 << contact::history_body_bits) - 1;
    for (const std::int32_t body : {0, 1, 2, last - 1, last})
    {
        for (const std::uint32_t point : {0U, 1U, 2U, 0x7fffffffU, 0x80000000U, 0xfffffffeU, 0xffffffffU})
        {
            for (int sample = 0; sample <= 9; ++sample) { keys.insert(contact::history_key(body, point, sample)); }
        }
    }
    EXPECT_EQ(keys.size(), 5u * 7u * 10u);
    EXPECT_EQ(keys.count(0), 0u);
}

} // namespace
} // namespace tread::test
