#pragma once

#include "backend/array.hpp"
#include "kernels/dem/bodies.hpp"
#include "kernels/dem/contact/patch_kern.hpp"
#include "kernels/dem/contact/rolling_kern.hpp"

// Several patches between two bodies. A pair that touches at separate places, or in directions far apart, stands once
// for each of them in the list of pairs, with its own run of nodes and its own record of friction: what happens in the
// substeps is then that of any pair.
namespace tread::dem
{

template<class Exec>
struct Pairs;
struct BodyLaw;

/// Of the pairs that touch in several patches; all empty in a scene whose bodies are convex.
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

    bool wanted = false; ///< some body is concave

    Array<Exec, Vec3<double>>
        place; ///< m, of the patch, from the centre of a in its frame; empty if no pair has several
    Array<Exec, Vec3<double>>  last_place; ///< of the last list
    Array<Exec, std::int32_t>  group;      ///< of every listed node
    Array<Exec, std::int32_t>  first;      ///< [pairs + 1]
    Array<Exec, std::int32_t>  several;    ///< first rows of the pairs with a concave body
    Array<Exec, std::uint64_t> key;
    Array<Exec, Patch>         patch;
    Array<Exec, Rolling>       rolling;
    Array<Exec, std::int32_t>  first_node;
    Array<Exec, std::int32_t>  node;
};

/// Splits the pairs just listed, with their nodes, by the nodes that touch. A pair that had more rows in the last list
/// keeps them, without nodes: it may need them again. The records of the last list follow the nodes, shared by their
/// stiffness (a split keeps their energy, two that come together lose what they differ by).
void split_patches(const Cpu&, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law);
void split_patches(const Gpu&, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law);

/// Groups the nodes of a list anew. False if some pair wants more rows than it has: pairs are then to be found anew.
bool patch_rows_suffice(const Cpu&, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law);
bool patch_rows_suffice(const Gpu&, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law);

/// After that: what split_patches does, within the rows that each pair has.
void regroup_patches(const Cpu&, Pairs<Cpu>& pairs, const BodiesView& bodies, const BodyLaw& law);
void regroup_patches(const Gpu&, Pairs<Gpu>& pairs, const BodiesView& bodies, const BodyLaw& law);

} // namespace tread::dem
