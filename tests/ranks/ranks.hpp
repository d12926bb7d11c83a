#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "mpi_session.hpp"
#include "physics/harness.hpp"

// A scene on all ranks together beside the same scene on this one alone: the answer that the ranks are held to.
namespace tread::test
{

/// The pages of a box from the origin on, of the rank that owner(centre of a page) says.
template<class Owner>
decomp::Territory territory_of(const decomp::PageLattice& lattice, const Vec3<double>& size, Owner owner)
{
    const double width = mpm::page_edge * lattice.spacing;
    const auto   pages = [&](int c) { return static_cast<std::int32_t>(std::ceil(size[c] / width)) + 1; };

    std::vector<std::pair<std::uint64_t, std::int32_t>> owned;
    for (std::int32_t x = -1; x < pages(0); ++x)
    {
        for (std::int32_t y = -1; y < pages(1); ++y)
        {
            for (std::int32_t z = -1; z < pages(2); ++z)
            {
                const Vec3<double> centre = width * (Vec3<double>(x, y, z) + Vec3<double>::Constant(0.5));
                owned.emplace_back(mpm::page_key({x, y, z}), owner(centre));
            }
        }
    }
    std::sort(owned.begin(), owned.end());
    std::vector<std::uint64_t> keys;
    decomp::PageRanks          ranks;
    for (const auto& [key, rank] : owned)
    {
        keys.push_back(key);
        ranks.push_back(rank);
    }
    return {lattice, keys, ranks};
}

/// Slabs along x, of equal width, for the first `parts` ranks.
inline auto slabs(double length, int parts)
{
    return [=](const Vec3<double>& at)
    { return std::clamp(static_cast<int>(std::floor(parts * at[0] / length)), 0, parts - 1); };
}

/// Quarters that meet in a corner above `centre`: as many ranks as there are, and with three the last two quarters are
/// of one.
inline auto quarters(const Vec3<double>& centre, int ranks)
{
    return [=](const Vec3<double>& at)
    { return std::min((at[0] > centre[0] ? 1 : 0) + (at[1] > centre[1] ? 2 : 0), ranks - 1); };
}

/// The largest difference of two lists of numbers, relative to `scale`.
inline double difference(const std::vector<double>& one, const std::vector<double>& other, double scale)
{
    EXPECT_EQ(one.size(), other.size());
    double largest = 0;
    for (std::size_t i = 0; i < one.size(); ++i) { largest = std::max(largest, std::abs(one[i] - other[i]) / scale); }
    return largest;
}

template<class Exec>
class SideBySide
{
public:
    SideBySide(const Exec& exec, const std::string& text, decomp::Territory where)
        : territory_(std::move(where))
        , transport_(world(), exec, decomp::TransportChoice::automatic)
        , ranks_{transport_, territory_}
        , alone(exec, text)
        , together(exec, load_text(text), solver::build_world(load_text(text)), &ranks_)
    {
    }

    /// One step of both, of the same length and as many substeps.
    void advance()
    {
        const solver::TimeStep one = alone.advance(), all = together.advance();
        ASSERT_EQ(one.substeps, all.substeps);
        ASSERT_EQ(one.dt, all.dt);
    }

private:
    decomp::Territory       territory_;
    decomp::Transport<Exec> transport_;
    solver::Ranks<Exec>     ranks_;

public:
    Experiment<Exec> alone, together;
};

} // namespace tread::test
