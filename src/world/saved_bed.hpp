#pragma once

#include <map>
#include <string>
#include <vector>

#include "io/bed_file.hpp"
#include "io/snapshot.hpp"
#include "world/grading.hpp"
#include "world/touch_table.hpp"
#include "world/world.hpp"

// Saves beds of rocks that one run settles, and loads them in others.
namespace tread::world
{

/// Collects the rocks of a world at the positions of `bodies`, and their contacts with rocks or walls.
io::BedFile make_bed(const scene::Scene& scene, const World& world, const io::BodyFields& bodies,
                     const std::vector<ContactRecord>& contacts);

/// The beds from which the [[rocks]] tables of a scene start; each file is read once. InputError, with file, key and
/// accepted values, for a file that is not a bed, and where scene and bed do not match.
class SavedBeds
{
public:
    explicit SavedBeds(const scene::Scene& scene);

    /// Rocks that a table takes from its bed: those of its shape and material.
    std::vector<RockDraw> draws(std::size_t table) const;

    /// Adds them to the world, at rest at their saved positions. They must have the bed's form and stiffness, lie
    /// within the domain and be clear of the named bodies.
    void place(std::size_t table, World& world);

    /// Call when all tables are placed: adds the contacts to the world. All rocks of a bed must be used, since others
    /// may rest on them.
    void finish(World& world) const;

private:
    struct Bed
    {
        io::BedFile               file;
        std::vector<std::int64_t> body; ///< body of each rock of the file; -1 until a table takes it
    };

    static void              add_contacts(const Bed& bed, World& world);
    const Bed&               bed(std::size_t table) const;
    std::vector<std::size_t> taken(std::size_t table) const;
    [[noreturn]] void        refuse(std::size_t table, const std::string& what) const;
    void require_same_kind(std::size_t table, const io::BedKind& kind, const shape::ShapeTemplate& form) const;
    void require_room(std::size_t table, std::size_t body, const World& world) const;

    const scene::Scene&        scene_;
    TouchTable                 touch_; ///< of the first phase
    std::map<std::string, Bed> beds_;
};

} // namespace tread::world
