#include "decomp/exchange.hpp"

#include <random>

#include <gtest/gtest.h>

#include "backend.hpp"
#include "mpi_session.hpp"

// Exchange of rows between ranks: each arrives once, at the right place.
namespace tread::decomp
{
namespace
{

struct Pair
{
    double       value;
    std::int32_t rank, row;
};

constexpr std::int32_t rows_here = 1000;

using Lists = std::vector<std::vector<std::int32_t>>;

/// Rows that each rank sends to each: the same on all ranks, so that every rank knows what to expect.
std::vector<Lists> random_lists(int ranks, unsigned seed)
{
    std::mt19937       random(seed);
    std::vector<Lists> all;
    for (int from = 0; from < ranks; ++from)
    {
        Lists lists(static_cast<std::size_t>(ranks));
        for (int to = 0; to < ranks; ++to)
        {
            const auto count = to == from ? 0 : random() % 200;
            for (unsigned k = 0; k < count; ++k)
            {
                lists[static_cast<std::size_t>(to)].push_back(static_cast<std::int32_t>(random() % rows_here));
            }
        }
        all.push_back(lists);
    }
    return all;
}

double value_of(int rank, std::int32_t row) { return 1e6 * rank + row + 0.25; }

template<class Exec>
class Exchanges : public test::BackendTest<Exec>
{
protected:
    int ranks() const { return test::world().size(); }
    int rank() const { return test::world().rank(); }

    const Lists& own(const std::vector<Lists>& lists) const { return lists[static_cast<std::size_t>(rank())]; }

    Array<Exec, Pair> pairs()
    {
        std::vector<Pair> values;
        for (std::int32_t row = 0; row < rows_here; ++row) { values.push_back({value_of(rank(), row), rank(), row}); }
        Array<Exec, Pair> array(this->exec(), "pairs");
        array.assign(values);
        return array;
    }

    /// Rows of all ranks for this one, in their order of arrival.
    std::vector<Pair> expected(const std::vector<Lists>& lists) const
    {
        std::vector<Pair> rows;
        for (int from = 0; from < ranks(); ++from)
        {
            for (const std::int32_t row : lists[static_cast<std::size_t>(from)][static_cast<std::size_t>(rank())])
            {
                rows.push_back({value_of(from, row), from, row});
            }
        }
        return rows;
    }

    void expect_equal(const std::vector<Pair>& found, const std::vector<Pair>& wanted, std::size_t first)
    {
        ASSERT_EQ(found.size(), first + wanted.size());
        for (std::size_t k = 0; k < wanted.size(); ++k)
        {
            EXPECT_EQ(found[first + k].value, wanted[k].value);
            EXPECT_EQ(found[first + k].rank, wanted[k].rank);
            EXPECT_EQ(found[first + k].row, wanted[k].row);
        }
    }
};

TYPED_TEST_SUITE(Exchanges, test::Backends, test::BackendNames);

TYPED_TEST(Exchanges, BringEveryRowToItsRankInOrder)
{
    Transport<TypeParam> transport(test::world(), this->exec(), TransportChoice::automatic);
    Exchange<TypeParam>  exchange(transport, "test");
    const auto           lists = random_lists(this->ranks(), 1);
    exchange.plan(this->own(lists));
    const auto wanted = this->expected(lists);
    ASSERT_EQ(exchange.received(), static_cast<std::int64_t>(wanted.size()));

    Array<TypeParam, Pair> from = this->pairs();
    Array<TypeParam, Pair> to(this->exec(), "arrived", exchange.received() + 7);
    exchange.begin(columns(from.data()));
    exchange.finish(columns(to.data()), 7);
    this->expect_equal(to.to_host(), wanted, 7);
}

TYPED_TEST(Exchanges, PutRowsWhereTheReceiverWantsThem)
{
    Transport<TypeParam> transport(test::world(), this->exec(), TransportChoice::automatic);
    Exchange<TypeParam>  exchange(transport, "test");
    const auto           lists = random_lists(this->ranks(), 2);
    exchange.plan(this->own(lists));
    auto       wanted = this->expected(lists);
    const auto count  = static_cast<std::int32_t>(wanted.size());

    Array<TypeParam, std::int32_t> at(this->exec(), "places");
    std::vector<std::int32_t>      backwards;
    for (std::int32_t k = 0; k < count; ++k) { backwards.push_back(count - 1 - k); }
    at.assign(backwards);
    Array<TypeParam, Pair> from = this->pairs();
    Array<TypeParam, Pair> to(this->exec(), "arrived", count);
    exchange.begin(columns(from.data()));
    exchange.finish(columns(to.data()), at);
    std::reverse(wanted.begin(), wanted.end());
    this->expect_equal(to.to_host(), wanted, 0);
}

TYPED_TEST(Exchanges, CarryPlanesOfEveryWidthBesideEachOther)
{
    constexpr std::int64_t stride = rows_here + 24;
    Transport<TypeParam>   transport(test::world(), this->exec(), TransportChoice::automatic);
    Exchange<TypeParam>    exchange(transport, "test");
    const auto             lists = random_lists(this->ranks(), 3);
    exchange.plan(this->own(lists));
    const auto wanted = this->expected(lists);

    std::vector<double>       places(3 * stride, -1);
    std::vector<float>        masses(stride, -1);
    std::vector<std::uint8_t> kinds(stride, 0);
    for (std::int32_t row = 0; row < rows_here; ++row)
    {
        for (int c = 0; c < 3; ++c)
        {
            places[static_cast<std::size_t>(c * stride + row)] = value_of(this->rank(), row) + 0.1 * c;
        }
        masses[static_cast<std::size_t>(row)] = static_cast<float>(row) + 0.5F;
        kinds[static_cast<std::size_t>(row)]  = static_cast<std::uint8_t>(row % 251 + this->rank());
    }
    Array<TypeParam, double>       place(this->exec(), "place");
    Array<TypeParam, float>        mass(this->exec(), "mass");
    Array<TypeParam, std::uint8_t> kind(this->exec(), "kind");
    place.assign(places);
    mass.assign(masses);
    kind.assign(kinds);
    const auto all = [](auto& p, auto& m, auto& k, std::int64_t step)
    {
        Columns columns;
        columns.add(planes(k.data(), step, 1));
        columns.add(planes(p.data(), step, 3));
        columns.add(planes(m.data(), step, 1));
        return columns;
    };
    const std::int64_t             count = exchange.received();
    Array<TypeParam, double>       place_here(this->exec(), "place", 3 * count);
    Array<TypeParam, float>        mass_here(this->exec(), "mass", count);
    Array<TypeParam, std::uint8_t> kind_here(this->exec(), "kind", count);
    exchange.begin(all(place, mass, kind, stride));
    exchange.finish(all(place_here, mass_here, kind_here, count), 0);

    const auto found_places = place_here.to_host();
    const auto found_masses = mass_here.to_host();
    const auto found_kinds  = kind_here.to_host();
    for (std::size_t k = 0; k < wanted.size(); ++k)
    {
        for (std::size_t c = 0; c < 3; ++c)
        {
            EXPECT_EQ(found_places[c * wanted.size() + k], wanted[k].value + 0.1 * static_cast<double>(c));
        }
        EXPECT_EQ(found_masses[k], static_cast<float>(wanted[k].row) + 0.5F);
        EXPECT_EQ(found_kinds[k], static_cast<std::uint8_t>(wanted[k].row % 251 + wanted[k].rank));
    }
}

TYPED_TEST(Exchanges, GoBackToWhereTheyCameFrom)
{
    Transport<TypeParam> transport(test::world(), this->exec(), TransportChoice::automatic);
    Exchange<TypeParam>  there(transport, "there"), back(transport, "back");
    const auto           lists = random_lists(this->ranks(), 4);
    there.plan(this->own(lists));
    Array<TypeParam, Pair> from = this->pairs();
    Array<TypeParam, Pair> ghosts(this->exec(), "ghosts", there.received());
    there.begin(columns(from.data()));
    there.finish(columns(ghosts.data()), 0);

    std::vector<std::int32_t> each;
    for (std::int32_t k = 0; k < there.received(); ++k) { each.push_back(k); }
    back.plan(each, there.from(), there.to());
    Array<TypeParam, Pair> home(this->exec(), "home", there.sent());
    back.begin(columns(ghosts.data()));
    back.finish(columns(home.data()), 0);
    std::vector<Pair> wanted;
    for (const auto& list : this->own(lists))
    {
        for (const std::int32_t row : list) { wanted.push_back({value_of(this->rank(), row), this->rank(), row}); }
    }
    this->expect_equal(home.to_host(), wanted, 0);
}

TYPED_TEST(Exchanges, MayBeUnderWayTogetherAndEndInAnyOrder)
{
    Transport<TypeParam> transport(test::world(), this->exec(), TransportChoice::automatic);
    Exchange<TypeParam>  first(transport, "first"), second(transport, "second");
    const auto           some = random_lists(this->ranks(), 5), others = random_lists(this->ranks(), 6);
    first.plan(this->own(some));
    second.plan(this->own(others));
    Array<TypeParam, Pair> from = this->pairs();
    Array<TypeParam, Pair> of_first(this->exec(), "first", first.received());
    Array<TypeParam, Pair> of_second(this->exec(), "second", second.received());
    for (int turn = 0; turn < 100; ++turn) // more than a channel has tags
    {
        first.begin(columns(from.data()));
        second.begin(columns(from.data()));
        second.finish(columns(of_second.data()), 0);
        first.finish(columns(of_first.data()), 0);
    }
    this->expect_equal(of_first.to_host(), this->expected(some), 0);
    this->expect_equal(of_second.to_host(), this->expected(others), 0);
}

TYPED_TEST(Exchanges, AllocateOnceAndNothingWithoutRows)
{
    Transport<TypeParam>   transport(test::world(), this->exec(), TransportChoice::automatic);
    Exchange<TypeParam>    idle(transport, "idle"), busy(transport, "busy");
    Array<TypeParam, Pair> from = this->pairs();
    idle.plan(Lists(static_cast<std::size_t>(this->ranks())));
    idle.begin(columns(from.data()));
    idle.finish(columns(from.data()), 0);
    EXPECT_EQ(this->counters.bytes().count("idle"), 0U);
    EXPECT_EQ(this->counters.launches().count("pack rows"), 0U);

    const auto lists = random_lists(this->ranks(), 7);
    busy.plan(this->own(lists));
    Array<TypeParam, Pair> to(this->exec(), "arrived", busy.received());
    std::int64_t           held = 0;
    for (int turn = 0; turn < 3; ++turn)
    {
        busy.begin(columns(from.data()));
        busy.finish(columns(to.data()), 0);
        if (turn > 0) { EXPECT_EQ(this->counters.current_bytes(), held); }
        held = this->counters.current_bytes();
    }
}

TYPED_TEST(Exchanges, NoticeThatLessCameThanWasPlanned)
{
    if (this->ranks() < 2) { GTEST_SKIP() << "one rank"; }
    Transport<TypeParam>      transport(test::world(), this->exec(), TransportChoice::host);
    Exchange<TypeParam>       exchange(transport, "test");
    Array<TypeParam, Pair>    from = this->pairs();
    Array<TypeParam, Pair>    to(this->exec(), "arrived", 2);
    std::vector<std::int32_t> rows;
    std::vector<Route>        out, in;
    if (this->rank() == 0)
    {
        rows = {5};
        out  = {{1, 1}};
    }
    if (this->rank() == 1) { in = {{0, 2}}; }
    exchange.plan(rows, out, in);
    exchange.begin(columns(from.data()));
    if (this->rank() == 1) { EXPECT_THROW(exchange.finish(columns(to.data()), 0), EnvironmentError); }
    else { exchange.finish(columns(to.data()), 0); }
}

template<class Exec>
using Transports = test::BackendTest<Exec>;

TYPED_TEST_SUITE(Transports, test::Backends, test::BackendNames);

TYPED_TEST(Transports, SayWhatTheyAre)
{
    const Transport<TypeParam> any(test::world(), this->exec(), TransportChoice::automatic);
    const Transport<TypeParam> host(test::world(), this->exec(), TransportChoice::host);
    std::printf("automatic: %s\n", any.description().c_str());
    EXPECT_EQ(host.carrier(), is_gpu<TypeParam> ? Carrier::host : Carrier::mpi);
    if (!is_gpu<TypeParam>) { EXPECT_EQ(any.carrier(), Carrier::mpi); }
    if (any.carrier() == Carrier::mpi) { return; }
    EXPECT_THROW(Transport<TypeParam>(test::world(), this->exec(), TransportChoice::mpi), EnvironmentError);
}

} // namespace
} // namespace tread::decomp
