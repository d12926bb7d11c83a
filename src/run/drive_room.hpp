#pragma once

#include <optional>
#include <string>
#include <vector>

#include "world/world.hpp"

namespace tread::run
{

/// End of a drive's path along x.
struct WayEnd
{
    double      axle; ///< m, x of the axle at which a drive ends; infinite where there is no end
    std::string what; ///< "the wall at x = 1 m"
};

/// Range along x in which a driven body may move, from the world as built. A drive ends when a margin is left between
/// the body and the wall, or between the front of the body and the edge of the terrain: two cells, within which sand
/// and wall share grid nodes so that the body would press on the wall through the sand, and 5 % of the body's radius.
struct DriveRoom
{
    std::size_t body;  ///< index of a [[body]]
    double      start; ///< m, x of the axle
    double      reach; ///< m along x, from the axle to the farthest point of the rim as placed
    double      depth; ///< m downwards, likewise
    WayEnd      back;  ///< towards low x
    WayEnd      front;

    /// Terrain that the body stands on: sand and rocks within its width, extended from its start across gaps no longer
    /// than its reach, and over the whole width. Empty where it stands on none.
    struct Ground
    {
        double low_x, high_x, low_y, high_y, floor; ///< m
    };
    std::optional<Ground> ground;
};

/// Computes the range of every body that a phase drives.
std::vector<DriveRoom> drive_rooms(const scene::Scene& scene, const world::World& world);

/// The end that a drive has reached when its axle is at x (m), or null.
const WayEnd* reached_end(const DriveRoom& room, const scene::Drive& drive, double x);

/// Computes the distance (m) from the axle at x to the end; infinite where there is none, at most 0 at the end.
double distance_to_end(const DriveRoom& room, const scene::Drive& drive, double x);

/// Whether the axle (m) is no longer over the ground on which it started, or the rim is below its floor.
bool has_left(const DriveRoom& room, const Vec3<double>& axle);

/// Computes the least distance (m) that the axle must travel to leave the ground; infinite without ground, negative
/// where it has left.
double distance_to_leave(const DriveRoom& room, const Vec3<double>& axle);

/// How far a drive takes its body, m.
struct DriveWay
{
    std::size_t phase;
    double      way;    ///< along x, either way; without slip where the slip is free
    double      to_end; ///< from its start to the end of the range; infinite where there is none
};

/// Computes the way of every drive, in the order of `rooms` and phases.
std::vector<DriveWay> drive_ways(const scene::Scene& scene, const world::World& world,
                                 const std::vector<DriveRoom>& rooms);

/// Warns of drives of prescribed slip that are too long for their range, each with the duration that fits, and of
/// bodies in the way. The drives of a scene follow each other.
std::vector<std::string> drive_warnings(const scene::Scene& scene, const world::World& world,
                                        const std::vector<DriveRoom>& rooms);

/// Notes the same for drives with free slip, as far as they get without slip.
std::vector<std::string> drive_notes(const scene::Scene& scene, const world::World& world,
                                     const std::vector<DriveRoom>& rooms);

} // namespace tread::run
