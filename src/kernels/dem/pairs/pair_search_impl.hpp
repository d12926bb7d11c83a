#pragma once

#include <algorithm>

#include "backend/reduce.hpp"
#include "kernels/dem/pairs/pairs_kern.hpp"

// Search for pairs whose bounding spheres and surfaces may meet, for both backends. Include after a backend's for_each.
namespace tread::dem::pair_steps
{

/// What the search needs the maximum of.
struct SearchExtent
{
    double radius; ///< m, bounding radius plus allowed way; 0 = not in the cell grid
    double drift;  ///< m
};

/// Computes the extent of each body here, those that have just come from other ranks among them.
struct WriteExtent
{
    BodiesView          bodies;
    const TemplateView* templates;
    const std::int32_t* is_large;
    AllowedMotion       allowed;
    SearchExtent*       extent;

    TREAD_HD void operator()(std::int64_t b) const
    {
        extent[b] = {0, 0};
        if (!bodies.is_here(b)) { return; }
        extent[b].drift = allowed.drift_of(b);
        if (is_large[b] == 0) { extent[b].radius = bounding_radius(bodies, templates, b) + allowed.way_of(b); }
    }
};

struct WriteCell
{
    BodiesView          bodies;
    const std::int32_t* is_large;
    double              cell_size;
    std::uint64_t*      key;
    std::int32_t*       body;

    TREAD_HD void operator()(std::int64_t b) const
    {
        const Vec3<double>& x       = bodies.position[b];
        const bool          gridded = is_large[b] == 0 && bodies.is_here(b);
        key[b]                      = !gridded ? no_cell
                                               : cell_key_of(cell_coordinate(x[0], cell_size), cell_coordinate(x[1], cell_size),
                                                             cell_coordinate(x[2], cell_size));
        body[b]                     = static_cast<std::int32_t>(b);
    }
};

/// Writes the sphere of each body in the order of cells.
struct WriteSphere
{
    BodiesView          bodies;
    const SearchExtent* extent;
    const std::int32_t* cell_body;
    SearchSphere*       sphere;

    TREAD_HD void operator()(std::int64_t i) const
    {
        const std::int64_t b = cell_body[i];
        sphere[i]            = {bodies.position[b], extent[b].radius};
    }
};

/// Number of candidates of a part whose test is remembered.
inline constexpr std::int32_t remembered_candidates = 32;

struct CountPairs
{
    PairSearch     search;
    std::int32_t*  found;    ///< [parts + 1]
    std::uint32_t* accepted; ///< [parts]

    TREAD_HD void operator()(std::int64_t i) const
    {
        std::int32_t  own = 0, candidate = 0;
        std::uint32_t near = 0;
        if (i < search.part_count())
        {
            search.each_candidate(PairSearch::part_of(i),
                                  [&](std::uint64_t, const auto& is_near)
                                  {
                                      const bool found_near = is_near();
                                      own += found_near ? 1 : 0;
                                      if (found_near && candidate < remembered_candidates)
                                      {
                                          near |= std::uint32_t{1} << candidate;
                                      }
                                      ++candidate;
                                  });
            accepted[i] = near;
        }
        found[i] = own;
    }
};

struct WritePairs
{
    PairSearch           search;
    const std::int32_t*  found;    ///< [parts + 1], after the scan
    const std::uint32_t* accepted; ///< [parts]
    std::uint64_t*       key;

    TREAD_HD void operator()(std::int64_t i) const
    {
        std::int32_t place = found[i], candidate = 0;
        if (place == found[i + 1]) { return; }
        search.each_candidate(PairSearch::part_of(i),
                              [&](std::uint64_t pair, const auto& is_near)
                              {
                                  const bool near = candidate < remembered_candidates
                                                        ? (accepted[i] >> candidate & 1u) != 0
                                                        : is_near();
                                  if (near) { key[place++] = pair; }
                                  ++candidate;
                              });
    }
};

/// Measures how wide the search is and whether anything drifts; returns the search radius of the widest body in the
/// grid, m.
template<class Exec>
double measure_extents(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    constexpr int width = sizeof(SearchExtent) / sizeof(double);
    pairs.search.extent.resize(width * (bodies.count + 1));
    auto* const extents = reinterpret_cast<SearchExtent*>(pairs.search.extent.data());
    for_each(exec, "body search radii", bodies.count,
             WriteExtent{bodies, law.templates, pairs.sizes.is_large.data(), pairs.displacement.view(), extents});
    double* const largest = pairs.search.extent.data() + width * bodies.count;
    largest_of_rows(exec, pairs.search.extent.data(), bodies.count, width, largest);
    const auto most             = read(exec, reinterpret_cast<const SearchExtent*>(largest));
    pairs.displacement.drifting = most.drift > 0;
    return most.radius;
}

/// Sorts the bodies into the cells of a grid as wide as the widest pair; returns the cell width.
template<class Exec>
double fill_cells(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law)
{
    const double cell_size = std::max(2.0 * measure_extents(exec, pairs, bodies, law), 1e-12);

    pairs.search.cell_key.resize(bodies.count);
    pairs.search.cell_body.resize(bodies.count);
    for_each(exec, "body cells", bodies.count,
             WriteCell{bodies, pairs.sizes.is_large.data(), cell_size, pairs.search.cell_key.data(),
                       pairs.search.cell_body.data()});
    sort_by_key(exec, pairs.search.cell_key, pairs.search.cell_body, pairs.sort);
    pairs.search.sphere.resize(bodies.count);
    for_each(exec, "body search spheres", bodies.count,
             WriteSphere{bodies, reinterpret_cast<const SearchExtent*>(pairs.search.extent.data()),
                         pairs.search.cell_body.data(), pairs.search.sphere.data()});
    return cell_size;
}

/// Makes the search of bodies sorted into cells.
template<class Exec>
PairSearch make_search(const Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, double cell_size)
{
    return {bodies,
            law,
            pairs.displacement.view(),
            cell_size,
            pairs.search.cell_key.data(),
            pairs.search.cell_body.data(),
            pairs.search.sphere.data(),
            pairs.sizes.large.data(),
            pairs.sizes.large.size(),
            pairs.sizes.is_large.data(),
            pairs.jointed.data(),
            pairs.jointed.size()};
}

template<class Exec>
void search(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, double cell_size)
{
    const PairSearch   search = make_search(pairs, bodies, law, cell_size);
    const std::int64_t items  = search.part_count();
    pairs.search.found.resize(items + 1);
    pairs.search.accepted.resize(items);
    for_each(exec, "count pairs", items + 1,
             CountPairs{search, pairs.search.found.data(), pairs.search.accepted.data()});
    pairs.key.resize(exclusive_scan(exec, pairs.search.found, pairs.sort));
    for_each(exec, "write pairs", items,
             WritePairs{search, pairs.search.found.data(), pairs.search.accepted.data(), pairs.key.data()});
}

} // namespace tread::dem::pair_steps
