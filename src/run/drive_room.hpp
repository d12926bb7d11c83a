#pragma once

#include <optional>
#include <string>
#include <vector>

#include "world/world.hpp"

namespace tread::run
{

/// An end of the way along x.
struct WayEnd
{
    double      axle; ///< m, x of the axle at which a drive ends; infinite where nothing ends it
    std::string what; ///< "the wall at x = 1 m"
};

/// Where a driven body may go, by the world as it is built. A drive ends when a margin is left between the body and
/// the wall, or between the front of the body and the edge of the terrain: two cells, within which sand and wall share
/// nodes of the grid so that the body would press on the wall through the sand, and 5 % of the body's radius.
struct DriveRoom
{
    std::size_t body;  ///< index of a [[body]]
    double      start; ///< m, x of the axle
    double      reach; ///< m, from the axle to the farthest point of the rim
    WayEnd      back;  ///< towards low x
    WayEnd      front;

    /// Terrain that the body stands on: sand and rocks within its width, from its start on as far as no gap is longer
    /// than its reach, and all of them across. Null where it stands on none.
    struct Ground
    {
        double low_x, high_x, low_y, high_y, floor; ///< m
    };
    std::optional<Ground> ground;
};

/// Computes the room of every body that a phase drives.
std::vector<DriveRoom> drive_rooms(const scene::Scene& scene, const world::World& world);

/// The end of the way that a drive is at when its axle is at x (m), or null.
const WayEnd* reached_end(const DriveRoom& room, const scene::Drive& drive, double x);

/// Computes the distance (m) that the axle at x has to the end of the way; infinite where nothing ends it, at most 0 at
/// the end.
double distance_to_end(const DriveRoom& room, const scene::Drive& drive, double x);

/// Whether the axle (m) is no longer over the ground that it started on, or the rim hangs below its floor.
bool has_left(const DriveRoom& room, const Vec3<double>& axle);

/// Computes the least distance (m) that the axle must go to have left; infinite without ground, negative where it has
/// left.
double distance_to_leave(const DriveRoom& room, const Vec3<double>& axle);

/// Drives of prescribed slip that are too long for their room, each with the duration that fits, and bodies that stand
/// in their way. The drives of a scene follow each other.
std::vector<std::string> drive_warnings(const scene::Scene& scene, const world::World& world,
                                        const std::vector<DriveRoom>& rooms);

/// The same of drives that are free to slip, as far as they get without slip.
std::vector<std::string> drive_notes(const scene::Scene& scene, const world::World& world,
                                     const std::vector<DriveRoom>& rooms);

} // namespace tread::run
