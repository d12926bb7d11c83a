#pragma once

#include <map>
#include <string>
#include <vector>

#include "io/bed_file.hpp"
#include "io/snapshot.hpp"
#include "world/grading.hpp"
#include "world/world.hpp"

// Beds of rocks that one run settles and others start with.
namespace tread::world
{

/// The rocks of a world at the places of `bodies`, and those of their contacts that are with rocks or walls.
io::BedFile make_bed(const scene::Scene& scene, const World& world, const io::BodyFields& bodies,
                     const std::vector<ContactRecord>& contacts);

/// The beds that the [[rocks]] tables of a scene start from, each file read once. InputError, with file, key and what
/// is accepted, for a file that is no bed, and where scene and bed do not go together.
class SavedBeds
{
public:
    explicit SavedBeds(const scene::Scene& scene);

    /// The rocks that a table takes from its bed: those of its shape and material.
    std::vector<RockDraw> draws(std::size_t table) const;

    /// Adds them to the world, at rest where they lay. They must have the bed's form and stiffness, lie within the
    /// domain and clear of the named bodies.
    void place(std::size_t table, World& world);

    /// When all tables are placed: gives the contacts to the world. No rock of a bed may be left over, which others may
    /// lean on.
    void finish(World& world) const;

private:
    struct Bed
    {
        io::BedFile               file;
        std::vector<std::int64_t> body; ///< of each rock of the file; -1 while no table has taken it
    };

    static void              add_contacts(const Bed& bed, World& world);
    const Bed&               bed(std::size_t table) const;
    std::vector<std::size_t> taken(std::size_t table) const;
    [[noreturn]] void        refuse(std::size_t table, const std::string& what) const;
    void require_same_kind(std::size_t table, const io::BedKind& kind, const shape::ShapeTemplate& form) const;
    void require_room(std::size_t table, std::size_t body, const World& world) const;

    const scene::Scene&        scene_;
    std::map<std::string, Bed> beds_;
};

} // namespace tread::world
