#pragma once

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "backend/counters.hpp"

// Allocations and launches of each part of a scene; left_out.cpp and left_out_runs.cpp compare scenes with them.
namespace tread::test
{

using Names = std::set<std::string>;

struct Part
{
    Names arrays;
    Names kernels;
};

/// Everything that the counters recorded.
inline Part used_of(const Counters& counters)
{
    Part used;
    for (const auto& [name, bytes] : counters.bytes()) { used.arrays.insert(name); }
    for (const auto& [name, launches] : counters.launches()) { used.kernels.insert(name); }
    return used;
}

inline void expect_equal(const Names& used, const Names& written_down, const char* what)
{
    for (const std::string& name : used) { EXPECT_TRUE(written_down.count(name)) << what << " not needed: " << name; }
    for (const std::string& name : written_down) { EXPECT_TRUE(used.count(name)) << what << " not used: " << name; }
}

inline void expect_equal(const Part& used, const Part& written_down)
{
    expect_equal(used.arrays, written_down.arrays, "array");
    expect_equal(used.kernels, written_down.kernels, "kernel");
}

inline Part operator+(Part a, const Part& b)
{
    a.arrays.insert(b.arrays.begin(), b.arrays.end());
    a.kernels.insert(b.kernels.begin(), b.kernels.end());
    return a;
}

/// Terrain of an elastic material, with FLIP.
inline const Part sand = {{"cell first point",
                           "grid motion",
                           "grid sums",
                           "last step with moves",
                           "materials",
                           "neighbours of point pages",
                           "neighbours of wall pages",
                           "node page keys",
                           "node pages of point pages",
                           "order",
                           "order keys",
                           "order neighbour keys",
                           "order neighbour order",
                           "page moves",
                           "point census",
                           "point id",
                           "point list",
                           "point list cells",
                           "point mass",
                           "point material",
                           "point moves",
                           "point page first point",
                           "point page keys",
                           "point pages of node pages",
                           "point peaks",
                           "point position",
                           "point start",
                           "point stress",
                           "point sums",
                           "point velocity",
                           "point volume",
                           "point volume ratio",
                           "sand sums on the host",
                           "sand totals",
                           "sort scratch",
                           "sort scratch keys",
                           "sort scratch values",
                           "tiles",
                           "wall nodes",
                           "wall pages",
                           "wall pages of node pages"},
                          {"census",
                           "find neighbours",
                           "find node pages",
                           "find point pages",
                           "find wall pages",
                           "first points",
                           "gather",
                           "gather points",
                           "largest of rows",
                           "list points",
                           "mark pages",
                           "mark wall pages",
                           "neighbour keys",
                           "point keys",
                           "scan",
                           "scatter",
                           "sort",
                           "sum rows",
                           "surrounding keys",
                           "update grid",
                           "update walls",
                           "write cells",
                           "write pages",
                           "write wall pages"}};

/// Additions of AFLIP and APIC.
inline const Part affine_velocities = {{"point affine velocity"}, {}};

/// Additions of a granular material.
inline const Part plastic_state = {{"point plastic rate", "point plastic shear", "point volume gap"}, {}};

/// Additions of a softening length.
inline const Part mean_strain = {
    {"cell mass of mean strain", "cell mean strain", "cell mean strain smoothed", "point mean strain"},
    {"cell strain", "mean strain of points", "smooth cell strain"}};

/// Bodies that may touch a wall or each other.
inline const Part bodies = {{"bodies by cell",
                             "bodies in contact",
                             "body activity",
                             "body angular velocity",
                             "body bounding radii",
                             "body cells",
                             "body damped",
                             "body expected stiffness",
                             "body force",
                             "body inertia",
                             "body locked freedoms",
                             "body mass",
                             "body material",
                             "body node area",
                             "body orientation",
                             "body orientation at search",
                             "body overlap on the host",
                             "body position",
                             "body position at search",
                             "body search radii",
                             "body search spheres",
                             "body scale",
                             "body speeds",
                             "body displacement a step more",
                             "body shape",
                             "body stiffness",
                             "body sums",
                             "body sums on the host",
                             "body torque",
                             "body totals",
                             "body allowed displacement",
                             "body drifts",
                             "body speeds beside drifts",
                             "time of drifts",
                             "body displacement shares",
                             "body displacement on the host",
                             "substeps of a list",
                             "body velocity",
                             "large body marks",
                             "nodes inside",
                             "nodes of pairs",
                             "pair measures",
                             "pair properties",
                             "pairs accepted",
                             "pairs by second body",
                             "pairs found",
                             "pairs of first body",
                             "pairs of second body",
                             "template part radii",
                             "template node parts",
                             "template node areas",
                             "template nodes",
                             "template sdf",
                             "templates",
                             "walls"},
                            {"allowed displacements",
                             "body search radii",
                             "body search spheres",
                             "body cells",
                             "body motion",
                             "body sizes",
                             "body speeds",
                             "body sums",
                             "contact frequencies",
                             "count pairs",
                             "expected contacts",
                             "largest of rows",
                             "mark pairs",
                             "measure activity",
                             "measure displacements",
                             "move bodies",
                             "nodes of kept pairs",
                             "pairs of bodies",
                             "scan",
                             "sort",
                             "stage bodies",
                             "sum rows",
                             "write pairs"}};

/// Additions of [[body]] tables for the recorder.
inline const Part named_bodies = {{"contact impulses", "shares of weight"}, {}};

/// Wheels, which may touch another body at several places.
inline const Part concave_bodies = {{"patches of pairs"}, {"group pair nodes", "pairs of several patches"}};

/// Bodies near each other or a wall.
inline const Part pairs = {{"last pair keys", "near clusters", "pair keys", "placed nodes"},
                           {"count pair nodes", "keep pairs", "place pair nodes"}};

/// All substeps run without sand.
inline const Part pairs_without_sand = {{"pair second bodies"}, {}};

/// Pairs found from the large bodies are sorted into the others.
inline const Part pairs_of_a_large_body = {{"sort scratch"}, {}};

/// Sand near bodies.
inline const Part contact_with_sand = {{"candidate body",
                                        "candidate point",
                                        "candidate touched point",
                                        "candidates by point",
                                        "contact cells",
                                        "contact cells found",
                                        "contact cells of a page",
                                        "contact dissipated",
                                        "contact page",
                                        "contact page body",
                                        "contact page boxes",
                                        "contact pages found",
                                        "contact part first item",
                                        "contact part run",
                                        "contact response",
                                        "contact run first part",
                                        "contact run marks",
                                        "contact run of body",
                                        "contact sort keys",
                                        "contact sorted points",
                                        "contact summary",
                                        "contact summary sums",
                                        "contact summary on the host",
                                        "contact tangential",
                                        "contact wrench sums",
                                        "point contact force",
                                        "point grid velocity",
                                        "point support",
                                        "private point id",
                                        "private point impulse",
                                        "private point mass",
                                        "private point material",
                                        "private point position",
                                        "private point radius",
                                        "private point support",
                                        "private point velocity",
                                        "touched bodies",
                                        "touched body first candidate",
                                        "touched point first candidate",
                                        "touched points"},
                                       {"bodies in sand",          "bodies without sand", "candidate sort keys",
                                        "candidate sorted points", "copy contact points", "count candidates",
                                        "count contact cells",     "count contact pages", "count parts",
                                        "find contact pages",      "give back impulses",  "mark runs",
                                        "move contact points",     "point-body forces",   "recall contacts",
                                        "summarise contacts",      "touched points",      "write candidates",
                                        "write contact pages",     "write parts",         "write runs"}};

inline const Part soil  = sand + affine_velocities + plastic_state;
inline const Part wheel = bodies + named_bodies + concave_bodies;

} // namespace tread::test
