#pragma once

#include <cstdint>
#include <vector>

#include "backend/array.hpp"
#include "backend/sort.hpp"
#include "kernels/dem/bodies.hpp"
#include "kernels/dem/contact/body_contact_kern.hpp"
#include "kernels/dem/contact/contact_body.hpp"
#include "kernels/dem/contact/pair_answers.hpp"
#include "kernels/dem/contact/patches.hpp"
#include "kernels/dem/contact/ray_kern.hpp"
#include "kernels/dem/contact/rolling_kern.hpp"
#include "kernels/dem/motion/shared.hpp"
#include "kernels/dem/pairs/displacement_limit.hpp"
#include "kernels/dem/sleep/sleeping_bodies.hpp"
#include "kernels/dem/templates.hpp"

// Contact lists: body pairs, body-wall pairs and their nodes, found for several coming steps and constant in between.
namespace tread::dem
{

/// The body-body contact law and its tables, in a backend's memory.
struct BodyLaw
{
    const TemplateView* templates;
    PairTable           pairs;
    const Plane*        planes;
    std::int32_t        plane_count;
    ContactOptions      options;
    const RayView*      rays = nullptr; ///< rays of the templates; null: bodies touch through their distance fields
};

/// Number of lowest bits of a key that number the patches of a pair that touches in several (patches.hpp); 0 for other
/// pairs.
inline constexpr int patch_bits = 3;

/// Maximum number of bodies and walls that keys can distinguish.
inline constexpr std::int64_t most_bodies = std::int64_t{1} << (32 - patch_bits);

/// Key of a pair, a < b; the wall `plane` has b = bodies + plane, below most_bodies.
TREAD_HD std::uint64_t pair_key(std::int64_t a, std::int64_t b)
{
    return static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint64_t>(b) << patch_bits;
}
TREAD_HD std::int64_t first_of(std::uint64_t key) { return static_cast<std::int64_t>(key >> 32); }
TREAD_HD std::int64_t second_of(std::uint64_t key)
{
    return static_cast<std::int64_t>((key & 0xffffffffu) >> patch_bits);
}
/// Returns the key without the patch number.
TREAD_HD std::uint64_t whole_pair(std::uint64_t key) { return key >> patch_bits << patch_bits; }
/// Returns the patch number of a key.
TREAD_HD std::uint64_t patch_number(std::uint64_t key) { return key - whole_pair(key); }
TREAD_HD bool same_pair(std::uint64_t one, std::uint64_t other) { return one >> patch_bits == other >> patch_bits; }

/// Number of bits in a word of PairsView::inside, and the number of words for so many nodes plus one extra, because a
/// run may read past its end.
inline constexpr std::int32_t nodes_of_word = 32;
inline std::int64_t           node_words(std::int64_t nodes) { return nodes / nodes_of_word + 2; }

struct PairsView
{
    std::int64_t         count;
    const std::uint64_t* key; ///< ascending
    Patch*               patch;
    double*              peak;      ///< m, maximum overlap since the pairs were found
    const std::int32_t*  first;     ///< [bodies + 1], first pair of each body's run as first body
    const std::int32_t*  by_second; ///< pairs ordered by their second body
    const std::int32_t*  second;    ///< [bodies + 1], first entry of each body's run in by_second
    Rolling*             rolling;   ///< null if no pair of materials has rolling friction
    AnswersView          answers;   ///< of the last substep
    ContactBody*         body;      ///< record of every body

    AllowedMotion       allowed;    ///< for which the list is valid
    const std::int32_t* first_node; ///< [pairs + 1], first node of each pair's run of nodes that may touch
    const std::int32_t* node;       ///< i of the first body, ~i of the second
    const std::int32_t* many;       ///< pairs with more than many_nodes nodes (contact_nodes.hpp)
    std::int64_t        many_count;
    const std::int32_t* pair_of_node;
    std::int64_t        node_count;
    FoundNode*          found_node; ///< result of the last check of the nodes
    std::uint32_t*      inside;     ///< [node_words], bit i of all: node i was inside at the last check
};

/// Records of the previous list, from which pairs that are found again take theirs.
template<class Exec>
struct LastRecords
{
    explicit LastRecords(const Exec& exec)
        : key(exec, "last pair keys")
        , patch(exec, "last pair patches")
        , rolling(exec, "last pair rolling moments")
    {
    }

    Array<Exec, std::uint64_t> key; ///< ascending
    Array<Exec, Patch>         patch;
    Array<Exec, Rolling>       rolling;
};

/// Runs of pairs of each body, as in PairsView.
template<class Exec>
struct PairsOfBodies
{
    explicit PairsOfBodies(const Exec& exec)
        : first(exec, "pairs of first body")
        , by_second(exec, "pairs by second body")
        , second(exec, "pairs of second body")
    {
    }

    Array<Exec, std::int32_t> first;
    Array<Exec, std::int32_t> by_second;
    Array<Exec, std::int32_t> second;
};

/// Nodes of the pairs that may touch, as in PairsView, and where they were at the last check.
template<class Exec>
struct PairNodes
{
    explicit PairNodes(const Exec& exec)
        : first(exec, "nodes of pairs")
        , node(exec, "pair nodes")
        , pair(exec, "pairs of nodes")
        , found(exec, "nodes found")
        , inside(exec, "nodes inside")
        , many(exec, "pairs of many nodes")
    {
    }

    Array<Exec, std::int32_t>  first;
    Array<Exec, std::int32_t>  node;
    Array<Exec, std::int32_t>  pair; ///< pair of each node
    Array<Exec, FoundNode>     found;
    Array<Exec, std::uint32_t> inside;
    Array<Exec, std::int32_t>  many; ///< empty on the host, where one lane handles any pair
};

/// Sizes of the bodies, by which the search treats them; set by classify_bodies.
template<class Exec>
struct BodySizes
{
    explicit BodySizes(const Exec& exec)
        : large(exec, "large bodies")
        , is_large(exec, "large body marks")
        , node_area(exec, "body node area")
    {
    }

    Array<Exec, std::int32_t> large;     ///< bodies that are not in the cell grid
    Array<Exec, std::int32_t> is_large;  ///< per body
    Array<Exec, double>       node_area; ///< m2, mean node area of each body
};

/// Displacement of each body for which a list is valid, and what it is computed from.
template<class Exec>
struct AllowedDisplacement
{
    explicit AllowedDisplacement(const Exec& exec)
        : allowed(exec, "body allowed displacement")
        , drift(exec, "body drifts")
        , span(exec, "time of drifts", 1)
        , speed(exec, "body speeds")
        , wander(exec, "body speeds beside drifts")
        , per_step(exec, "body displacement a step more")
    {
        span.fill_zero();
    }

    AllowedMotion view() const { return {allowed.data(), drifting ? drift.data() : nullptr, span.data()}; }

    Array<Exec, double>       allowed;          ///< m, AllowedMotion::displacement
    Array<Exec, Vec3<double>> drift;            ///< m/s
    Array<Exec, double>       span;             ///< s
    bool                      drifting = false; ///< false: no body here drifts, so that nothing need look

    Array<Exec, double> speed;    ///< m/s, maximum over each body's points at the start of the search
    Array<Exec, double> wander;   ///< m/s, at which a body's displacement may grow beside its drift
    Array<Exec, double> per_step; ///< bounding radii, of bodies here: extra Verlet skin for one further step
};

/// The nodes of a cluster that may enter the other body of a pair.
struct NearCluster
{
    std::int32_t  name;  ///< i of the first body, ~i of the second
    std::uint32_t nodes; ///< bit n: node n of the cluster

    TREAD_HD bool first_body() const { return name >= 0; }
    TREAD_HD std::int32_t index() const { return first_body() ? name : ~name; }
};

/// Where a body's nodes lie in the field of the other body of a pair, or of a wall: `turn` and `shift` take a place in
/// their template's frame into the cells of the other template's grid, or make its distance from the wall (m) their
/// first component. Lengths are in the other template, or in the world.
struct alignas(16) PlacedNodes
{
    Mat3<float> turn;     ///< cells / m
    Vec3<float> shift;    ///< cells
    float       bound;    ///< of the field at a node that may enter
    float       scale;    ///< over lengths of the nodes' template
    float       way;      ///< that nodes may come nearer, with the rounding
    float       rounding; ///< m, of the field
};

/// Room for the clusters that are recorded for a pair, and for the end of the record; the nodes of a pair with as many
/// clusters as this, or more, are looked for twice.
inline constexpr std::int32_t near_clusters = 8;

/// Sphere that no point of a body leaves until the pairs are found again.
struct SearchSphere
{
    Vec3<double> centre; ///< m
    double       radius; ///< m

    TREAD_HD bool meets(const SearchSphere& other) const
    {
        const double together = radius + other.radius;
        return (centre - other.centre).squaredNorm() <= together * together;
    }
};

/// Scratch memory of the search by cells of a grid.
template<class Exec>
struct PairSearchScratch
{
    explicit PairSearchScratch(const Exec& exec)
        : extent(exec, "body search radii")
        , cell_key(exec, "body cells")
        , cell_body(exec, "bodies by cell")
        , sphere(exec, "body search spheres")
        , found(exec, "pairs found")
        , accepted(exec, "pairs accepted")
        , second_key(exec, "pair second bodies")
        , placed(exec, "placed nodes")
        , near(exec, "near clusters")
        , counted(exec, "pairs counted")
    {
    }

    Array<Exec, double>        extent;   ///< SearchExtent of each body, and the maximum
    Array<Exec, std::uint64_t> cell_key; ///< ascending
    Array<Exec, std::int32_t>  cell_body;
    Array<Exec, SearchSphere>  sphere; ///< of the bodies of cell_body
    Array<Exec, std::int32_t>  found;
    Array<Exec, std::uint32_t> accepted; ///< per part of the search: the candidates found near, a bit each
    Array<Exec, std::uint64_t> second_key;
    Array<Exec, PlacedNodes>   placed;  ///< [2 * pairs], of the first body, then the second
    Array<Exec, NearCluster>   near;    ///< [pairs * near_clusters], up to the first without nodes; 0 last if complete
    Array<Exec, std::int32_t>  counted; ///< place of each pair in `near`
};

/// Memory of PairsView, and of the search for pairs.
template<class Exec>
struct Pairs
{
    explicit Pairs(const Exec& exec)
        : key(exec, "pair keys")
        , patch(exec, "pair patches")
        , rolling(exec, "pair rolling moments")
        , peak(exec, "pair peak overlaps")
        , answers(exec)
        , of_body(exec)
        , nodes(exec)
        , patches(exec)
        , last(exec)
        , body(exec, "bodies in contact")
        , expected_stiffness(exec, "body expected stiffness")
        , jointed(exec, "pairs of jointed bodies")
        , sizes(exec)
        , displacement(exec)
        , sleep(exec)
        , search(exec)
        , measure(exec, "pair measures")
        , sort(exec)
    {
    }

    PairsView view()
    {
        return {key.size(),
                key.data(),
                patch.data(),
                peak.data(),
                of_body.first.data(),
                of_body.by_second.data(),
                of_body.second.data(),
                resists_rolling ? rolling.data() : nullptr,
                answers.view(),
                body.data(),
                displacement.view(),
                nodes.first.data(),
                nodes.node.data(),
                nodes.many.data(),
                nodes.many.size(),
                nodes.pair.data(),
                nodes.node.size(),
                nodes.found.data(),
                nodes.inside.data()};
    }

    // The list, in ascending order of keys, and its records.
    Array<Exec, std::uint64_t> key;
    Array<Exec, Patch>         patch;
    Array<Exec, Rolling>       rolling; ///< empty unless resists_rolling
    Array<Exec, double>        peak;
    Answers<Exec>              answers;
    PairsOfBodies<Exec>        of_body;
    PairNodes<Exec>            nodes;
    Patches<Exec>              patches;
    LastRecords<Exec>          last;
    bool                       resists_rolling = false; ///< whether some pair of materials has rolling friction

    // The bodies.
    Array<Exec, ContactBody>   body;
    Array<Exec, double>        expected_stiffness; ///< N/m, per body (contact_limits.hpp)
    Array<Exec, std::uint64_t> jointed;            ///< keys of pairs that never touch, ascending; set once
    BodySizes<Exec>            sizes;
    AllowedDisplacement<Exec>  displacement;
    SleepingBodies<Exec>       sleep;

    // Scratch memory.
    PairSearchScratch<Exec> search;
    Array<Exec, double>     measure;
    SortScratch<Exec>       sort;
};

/// m, bounding radius beyond which a body is tested against all others instead of entering the cell grid, because it
/// would set the cell size: 4 times the median of `radii`.
double largest_in_grid(std::vector<double> radii);

/// Sorts the bodies by size: those beyond `largest` (largest_in_grid) are large. Call once, and again when bodies are
/// added, removed or reordered.
template<class Exec>
void classify_bodies(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const TemplateView* templates,
                     double largest);

/// Lists the large bodies anew from pairs.sizes.is_large.
template<class Exec>
void list_large_bodies(const Exec& exec, Pairs<Exec>& pairs);

/// Forgets which pairs each body has, as rows of bodies have changed altogether.
template<class Exec>
void forget_list(Pairs<Exec>& pairs)
{
    pairs.of_body.first.fit(0);
    pairs.of_body.by_second.fit(0);
    pairs.of_body.second.fit(0);
}

/// Copies the body data that contacts read. Needed again after anything but move_bodies has changed the bodies;
/// find_pairs calls it.
template<class Exec>
void stage_bodies(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies);

/// Finds every pair of bodies, and of body and wall, that may touch within the next dt (s, of the MPM step), and the
/// nodes of each pair that may enter the other body (contact_nodes.hpp). The lists are complete while bodies move as
/// pairs.displacement allows. Patches of pairs that stay in the list are kept. `substeps`: number of substeps of such a
/// step; it sets how many steps the list should remain valid. `gravity`: m/s2.
template<class Exec>
void find_pairs(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt,
                double substeps = 1, double gravity = 0);

/// find_pairs in parts, between which ranks exchange data. First part: the present list becomes the previous one, and
/// pairs.displacement.speed is measured.
template<class Exec>
void begin_list(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law);

/// Computes this rank's shares of shared.near, which are then exchanged; several ranks only.
template<class Exec>
void share_speeds(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law,
                  const SharedView& shared);

/// Second part: lets bodies drift whose neighbours in the previous list go along with them, since the rocks of a
/// falling bed would else be listed with all that lies in their way; computes pairs.displacement.per_step and its sum
/// in pairs.measure, which the caller replaces by that of all ranks.
template<class Exec>
void request_displacement(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt,
                          double gravity, const SharedView& shared);

/// Third part: computes pairs.displacement.allowed of bodies that are here; owners send it to new ghosts. `all`: number
/// of bodies of all ranks.
template<class Exec>
void allow_displacement(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law, double dt,
                        double substeps, std::int64_t all);

/// Last part: lists the pairs that this rank evaluates, except those of two sleepers (sleep/sleep.hpp).
template<class Exec>
void list_pairs(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law);

/// Rebuilds everything that list_pairs derives, from a loaded list (pairs.key, patch, rolling, displacement.allowed,
/// nodes.first and node, patches.place and several). Overlaps start as for a new list.
template<class Exec>
void resume_list(const Exec& exec, Pairs<Exec>& pairs, const BodiesView& bodies);

} // namespace tread::dem
