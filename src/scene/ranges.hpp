#pragma once

#include "scene/values.hpp"

// Ranges of the quantities of a scene. They are wider than realistic values of sand, rock and wheels, and narrow enough
// that no estimate computed from them overflows a double or a 64-bit count.
namespace tread::scene
{

inline Range length() { return between(1e-6, 1e5); }        ///< m
inline Range length_or_none() { return between(0, 1e5); }   ///< m
inline Range coordinate() { return between(-1e5, 1e5); }    ///< m
inline Range acceleration() { return between(-1e4, 1e4); }  ///< m/s2: a thousand times Earth's gravity
inline Range velocity() { return between(-1e4, 1e4); }      ///< m/s
inline Range speed() { return between(1e-9, 1e4); }         ///< m/s
inline Range spin() { return between(-1e5, 1e5); }          ///< rad/s
inline Range density() { return between(1e-3, 1e6); }       ///< kg/m3
inline Range stiffness() { return between(1, 1e18); }       ///< Pa; diamond has 1e12
inline Range strength() { return between(0, 1e12); }        ///< Pa
inline Range mass() { return between(1e-12, 1e12); }        ///< kg
inline Range force() { return between(1e-12, 1e12); }       ///< N
inline Range span_of_time() { return between(1e-9, 1e10); } ///< s; three centuries
inline Range time_or_none() { return between(0, 1e10); }    ///< s
inline Range interval() { return between(1e-12, 1e12); }    ///< s; longer than any run: "never"
inline Range step_of_time() { return between(1e-12, 1e3); } ///< s
inline Range coefficient() { return between(0, 1e6); }      ///< of friction; nothing slips from 1e3 on
inline Range largest_scaling() { return between(1, 100); }  ///< of the inertia of rocks
inline Range pure_number() { return between(0, 1e6); }

} // namespace tread::scene
