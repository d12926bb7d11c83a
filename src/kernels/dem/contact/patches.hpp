#pragma once

#include "backend/array.hpp"
#include "kernels/dem/bodies.hpp"
#include "kernels/dem/contact/patch_kern.hpp"
#include "kernels/dem/contact/rolling_kern.hpp"

// Several contact patches between two bodies. A pair that touches at separate places, or in directions far apart, has
// one row for each patch in the list of pairs, with its own run of nodes and its own friction record: the substeps
// treat such a row as any other pair.
namespace tread::dem
{

template<class Exec>
struct Pairs;
struct BodyLaw;

/// Data of the pairs that touch in several patches; all arrays are empty if all bodies are convex.
template<class Exec>
struct Patches
{
    explicit Patches(const Exec& exec)
        : place(exec, "patch places")
        , last_place(exec, "last patch places")
        , group(exec, "patches of nodes")
        , first(exec, "patches of pairs")
        , several(exec, "pairs that may have several patches")
        , key(exec, "patch keys")
        , patch(exec, "patch records")
        , rolling(exec, "patch rolling moments")
        , first_node(exec, "nodes of patches")
        , node(exec, "patch nodes")
    {
    }

    bool wanted = false; ///< whether some body is concave

    Array<Exec, Vec3<double>>  place;      ///< m, patch position in a's body frame; empty if no pair has several
    Array<Exec, Vec3<double>>  last_place; ///< `place` of the previous list
    Array<Exec, std::int32_t>  group;      ///< patch of every listed node
    Array<Exec, std::int32_t>  first;      ///< [pairs + 1]
    Array<Exec, std::int32_t>  several;    ///< first rows of the pairs with a concave body
    Array<Exec, std::uint64_t> key;
    Array<Exec, Patch>         patch;
    Array<Exec, Rolling>       rolling;
    Array<Exec, std::int32_t>  first_node;
    Array<Exec, std::int32_t>  node;
};

/// Splits the newly listed pairs, with their nodes, by the nodes that touch. A pair that had more rows in the previous
/// list keeps them without nodes, because it may need them again. Friction records of the previous list follow the
/// nodes, shared in proportion to stiffness (a split conserves their energy; a merge dissipates their difference).
template<class Exec>
void split_patches(const Exec&, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law);

/// Groups the nodes of a list again. Returns false if some pair needs more rows than it has: the pairs must then be
/// found again.
template<class Exec>
bool patch_rows_suffice(const Exec&, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law);

/// Does what split_patches does within the rows that each pair has; call after patch_rows_suffice.
template<class Exec>
void regroup_patches(const Exec&, Pairs<Exec>& pairs, const BodiesView& bodies, const BodyLaw& law);

} // namespace tread::dem
