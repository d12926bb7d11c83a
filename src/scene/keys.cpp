#include "scene/keys.hpp"
#include "scene/ranges.hpp"
#include "scene/spellings.hpp"

namespace tread::scene
{
namespace
{

Keys<Drive> drive_keys()
{
    return {
        required("body", "", &Drive::body, name(), "The wheel that is driven: the name of a [[body]]."),
        required("angular_velocity", "rad/s", &Drive::angular_velocity, number(spin()),
                 "Spin about the wheel's axle; positive drives towards +x."),
        optional("ramp", "s", &Drive::ramp, number(time_or_none()),
                 "Time over which the spin goes linearly from its value at phase start to `angular_velocity`."),
        optional("slip", "", &Drive::slip, number_or("free", between(-1, 1)),
                 "Slip ratio s: the wheel is moved at v_x = (1 - s) omega r. \"free\" leaves v_x to the forces."),
    };
}

Keys<Lower> lower_keys()
{
    return {
        required("body", "", &Lower::body, name(), "The body that is lowered: the name of a [[body]]."),
        required("speed", "m/s", &Lower::speed, number(speed()),
                 "Speed along gravity; the body neither turns nor moves otherwise."),
        optional("share", "", &Lower::share, number(above_up_to(0, 1)),
                 "Share of the body's weight that contacts carry when the phase ends."),
    };
}

Keys<WeightShare> weight_keys()
{
    return {
        required("body", "", &WeightShare::body, name(), "The body: the name of a [[body]]."),
        required("from", "", &WeightShare::from, number(between(0, 10)), "Share of its weight that acts at first."),
        optional("to", "", &WeightShare::to, number(between(0, 10)), "Share of its weight that acts after the ramp."),
        optional("ramp", "s", &WeightShare::ramp, number(time_or_none()),
                 "Time over which the share goes linearly from `from` to `to`."),
    };
}

Keys<ContactSetting> contact_setting_keys()
{
    return {
        required("between", "", &ContactSetting::between, pair_of_names(),
                 "Two families, or a family and \"wall\". One setting a pair and phase."),
        optional("friction", "", &ContactSetting::friction, number_or("", coefficient()),
                 "Coulomb's coefficient, from this phase on until another one sets it.", "as before"),
        optional("restitution", "", &ContactSetting::restitution, number_or("", between(0, 1)),
                 "Coefficient of restitution between bodies and with walls, likewise.", "as before"),
        optional("touch", "", &ContactSetting::touch, boolean_given(),
                 "Whether the two touch at all, likewise. A pair that begins to touch must not overlap.", "as before"),
    };
}

bool may_end_early(const Phase& phase) { return phase.until != StopRule::duration; }

} // namespace

Keys<Scene> scene_keys()
{
    return {optional("title", "", &Scene::title, text(), "One line for logs and reports; changes no result.")};
}

Keys<GridOptions> grid_keys()
{
    return {
        optional("spacing", "m", &GridOptions::spacing, number(length()), "Edge length h of a grid cell.",
                 "required with [[terrain]]"),
        optional("refine", "m", &GridOptions::refine, boxes(),
                 "Boxes in which cells are smaller: half the edge length in the first one, a quarter in the second, an "
                 "eighth in the third, each inside the one before; points, where `points_per_cell` sets them, follow. "
                 "docs/refinement.md."),
    };
}

Keys<TimeOptions> time_keys()
{
    return {
        optional("dt", "s", &TimeOptions::dt, number_or("auto", step_of_time()),
                 "Time step. \"auto\" takes the largest stable one; a fixed one is checked."),
        optional("substeps", "", &TimeOptions::substeps, integer_or("auto", 1, most_substeps),
                 "Contact substeps in a step. \"auto\" takes as many as contact between bodies needs; a run that needs "
                 "more than 1000000 stops."),
        optional("contact_share", "", &TimeOptions::contact_share, number(between(0.001, 0.8)),
                 "Substep over sqrt(m / sum K) of the stiffest body, where substeps are \"auto\". Contacts are stable "
                 "to 1.1; over "
                 "0.4 single impacts lose their energy balance; at 0.001 their error is that of rounding."),
        optional("mass_scaling", "", &TimeOptions::mass_scaling, number(largest_scaling()),
                 "Largest factor by which the inertia of rocks in the stiffest contacts may be scaled up, so that they "
                 "do not shorten the substep of all; weights and contact forces stay. For slow flow alone. 1: none. "
                 "docs/theory.md#mass-scaling."),
    };
}

Keys<Numerics> numerics_keys()
{
    return {
        optional("precision", "", &Numerics::precision, word<Precision>(),
                 "Of velocities, stresses and grid sums; positions always resolve 1e-10 m."),
        optional(
            "transfer", "", &Numerics::transfer, word<Transfer>(),
            "How velocity goes between points and grid; \"aflip\" is FLIP that also gives the grid its points' affine "
            "velocities, as APIC does: docs/transfers.md."),
        optional(
            "pic_rate", "c_p/h", &Numerics::pic_rate, number_or("auto", coefficient()),
            "PIC part of FLIP per unit time. \"auto\": 0.2 for granular materials, 0.04 for elastic ones; the largest "
            "of the materials of the sand holds for all of it.")
            .when("transfer = \"flip\" or \"aflip\"",
                  [](const Numerics& numerics) { return numerics.transfer != Transfer::apic; }),
        optional("shape_functions", "", &Numerics::shape_functions, word<ShapeFunctions>(), "B-splines of the grid."),
        optional("narrow_phase", "", &Numerics::narrow_phase, word<NarrowPhase>(),
                 "How deep a surface node is in another body: by that body's distance field, or by the length of a ray "
                 "along the node's inward normal to that body's triangles: docs/rays.md."),
        optional("point_motion", "", &Numerics::point_motion, word<PointMotion>(),
                 "How a point moves within the contact substeps of a step: held up by the grid's acceleration, freely, "
                 "or not at all (the paper's)."),
        optional("hertz", "", &Numerics::hertz, word<HertzFactor>(),
                 "Factor of the contact force: 4/3 E* sqrt(R*) d^1.5, or the paper's Eq. 7, which is 1/sqrt(2) of it."),
        optional("point_radius", "", &Numerics::point_radius, word<PointRadius>(),
                 "Contact radius of a point: of the sphere of its initial volume V (Eq. 11), or 0.5 V^(1/3)."),
        optional("refine_below", "point radii", &Numerics::refine_below, number(pure_number()),
                 "Bodies whose sphere of equal volume has a smaller radius than this many of the largest point's are "
                 "sampled at nine places of each point's contact patch, not at its centre alone; 0: none."),
        optional("volume_strain", "", &Numerics::volume_strain, word<VolumeStrain>(),
                 "Volumetric strain that the material law sees: each point's own, or the mean over its cell's points, "
                 "against locking where the flow keeps its volume (undrained clay, sand that does not dilate)."),
        optional("linear_overlap", "R*", &Numerics::linear_overlap, number(between(1e-9, 0.1)),
                 "Overlap below which traction between bodies is linear; 1e-2 allows 1.8 times the step of 1e-3."),
    };
}

Keys<Contact> contact_keys()
{
    return {
        required("between", "", &Contact::between, pair_of_names(),
                 "Two families, or a family and \"wall\". Pairs that are left out get the defaults below."),
        optional("friction", "", &Contact::friction, number(coefficient()), "Coulomb's coefficient.",
                 "0.3; with \"wall\" 0.5"),
        optional("restitution", "", &Contact::restitution, number(between(0, 1)),
                 "Coefficient of restitution between bodies and with walls; points have none."),
        optional(
            "rolling_friction", "", &Contact::rolling_friction, number(between(0, 1)),
            "Coefficient mu_r of the moment that resists rolling, at most mu_r R* F, between bodies and with walls "
            "that have friction; points have none. A ball stays on a slope of up to atan(mu_r)."),
        optional("touch", "", &Contact::touch, boolean(),
                 "Whether the two touch at all; if not, they pass through each other. At least one family is that of "
                 "rocks or bodies; a family with itself is a pair too. A phase may change it: docs/phases.md."),
    };
}

Keys<Terrain> terrain_keys()
{
    const auto        on_the_grid = [](const Terrain& terrain) { return !terrain.spacing && terrain.from.empty(); };
    const std::string made        = "`from` left out";
    const auto        is_made     = [](const Terrain& terrain) { return terrain.from.empty(); };
    return {
        required("material", "", &Terrain::material, name(), "The name of a [[material]] that is not rigid."),
        optional("from", "", &Terrain::from, path(),
                 "A bed that another run saved (`[output] bed_after`): the points of this material in it, where they "
                 "lay, at rest, with their stress. A relative path starts at the scene file. The material and the "
                 "grid's spacing must be those of the bed.",
                 "points are made on a lattice"),
        terrain_region_key().when(made, is_made),
        terrain_height_key().when(made, is_made),
        terrain_floor_key().when(made, is_made),
        optional("points_per_cell", "", &Terrain::points_per_cell, integer_of({1, 8, 27, 64}),
                 "Points in a grid cell: 1, 2, 3 or 4 each way.")
            .when("`from` and `spacing` left out", on_the_grid),
        optional("spacing", "m", &Terrain::spacing, number_or("", length()),
                 "Distance of the points instead of `points_per_cell`: a lattice that begins half a spacing inside the "
                 "region's low corner.",
                 "by `points_per_cell`")
            .when(made, is_made),
        optional("velocity", "m/s", &Terrain::velocity, vector3(velocity()), "Of the points at the start.")
            .when(made, is_made),
    };
}

Keys<Rocks> rocks_keys()
{
    const std::string one_of = "exactly one of count, solid_fraction", drawn = "`from` left out";
    const auto        are_drawn = [](const Rocks& rocks) { return rocks.from.empty(); };
    return {
        required("shape", "", &Rocks::shape, name(),
                 "The name of a [[shape]]. Each rock draws its form from the shape's `variants`."),
        required("material", "", &Rocks::material, name(), "The name of an elastic or rigid [[material]]."),
        optional(
            "from", "", &Rocks::from, path(),
            "A bed that another run saved (`[output] bed_after`): the rocks of this shape and material in it, where "
            "they lay, at rest, with their contacts, so that friction holds. A relative path starts at the scene "
            "file. Shape and material must be those of the bed; `[[contact]]` may differ.",
            "the rocks are drawn and placed"),
        optional("count", "", &Rocks::count, integer_given(1, 100'000'000), "How many.", one_of).when(drawn, are_drawn),
        optional(
            "solid_fraction", "", &Rocks::solid_fraction, number_or("", above_up_to(0, 1)),
            "Volume of the rocks over the volume of the region between `floor` and `height`; the drawn rocks whose "
            "volume comes nearest. Random places jam at about 0.3 for one size, higher for graded ones.",
            one_of)
            .when(drawn, are_drawn),
        rocks_diameter_key().when(drawn, are_drawn),
        rocks_region_key().when(drawn, are_drawn),
        rocks_height_key().when(drawn, are_drawn),
        rocks_floor_key().when(drawn, are_drawn),
        optional(
            "placement", "", &Rocks::placement, word<Placement>(),
            "Rocks never overlap. \"replace\": at random, in place of as much sand as the rocks have volume there; "
            "\"points\": the same, each where a point of sand stands, drawn at random; \"rain\": at random, "
            "where there is no sand, to fall from; \"grid\": on a lattice, where there is no sand."),
        optional("allow_voids", "", &Rocks::allow_voids, boolean(),
                 "Whether over 5 % of the layer that these rocks stand in may be void, as where rocks are as small as "
                 "the points of sand around them.")
            .when("placement = \"replace\" or \"points\"",
                  [](const Rocks& rocks) { return takes_sand(rocks.placement); }),
        optional("seed", "", &Rocks::seed, integer<std::uint64_t>(0),
                 "Of the random sizes, forms, places and orientations.")
            .when(drawn, are_drawn),
    };
}

Keys<Phase> phase_keys()
{
    return {
        required("name", "", &Phase::name, name(), "Unique among phases."),
        optional("hold", "", &Phase::hold, names(), "Bodies that do not move in this phase: names of [[body]]."),
        optional("damping", "", &Phase::damping, number(from_below(0, 1)),
                 "Local (Cundall) damping of sand and rocks; for settling only."),
        optional("until", "", &Phase::until, word<StopRule>(),
                 "What ends the phase: its time, rest of sand and rocks, or that the ground carries what is lowered."),
        required("duration", "s", &Phase::duration, number(span_of_time()), "Simulated time of the phase.")
            .when("until = \"duration\"", [](const Phase& phase) { return phase.until == StopRule::duration; }),
        required("max_duration", "s", &Phase::max_duration, number(span_of_time()),
                 "Simulated time after which the phase ends all the same, with a warning.")
            .when("until = \"equilibrium\" or \"lowered\"", may_end_early),
        table_key<Phase>(Presence::optional, "drive", "[[phase]] drive", &Phase::drive, drive_keys(),
                         "Prescribed spin, and by `slip` prescribed speed, of one wheel.", "no body is driven"),
        table_key<Phase>(Presence::required, "lower", "[[phase]] lower", &Phase::lower, lower_keys(),
                         "A body that goes down at a given speed until the ground carries it; the other way to put a "
                         "wheel on sand is to drop it, which makes it sink twice as deep.",
                         "required")
            .when("until = \"lowered\"", [](const Phase& phase) { return phase.until == StopRule::lowered; }),
        table_key<Phase>(Presence::optional, "weight", "[[phase]] weight", &Phase::weight, weight_keys(),
                         "The share of one body's weight that acts, as if a counterweight held the rest.",
                         "all of it acts"),
        phase_motion_key(),
        phase_motors_key(),
        optional(
            "gravity", "m/s2", &Phase::gravity, vector3_given(acceleration()),
            "Acceleration of gravity, from this phase on until another one sets it, as of a bed that tilts. Potential "
            "energy counts from where everything is then.",
            "as before"),
        tables_key<Phase>("contacts", "[[phase]] contacts", &Phase::contacts, contact_setting_keys(),
                          "What changes in contacts from this phase on.", "nothing"),
        optional("mass_scaling", "", &Phase::mass_scaling, number_or("", largest_scaling()),
                 "As that of [time], from this phase on until another one sets it: to let a bed of rocks settle, say, "
                 "before something falls on it with 1.",
                 "as before"),
    };
}

Keys<Output> output_keys()
{
    return {
        optional("every", "s", &Output::every, number(interval()), "Simulated time between rows of the time series."),
        optional("snapshots_every", "s", &Output::snapshots_every, zero_or(interval()),
                 "Simulated time between snapshots; 0 writes none."),
        optional(
            "bed_after", "", &Output::bed_after, name(),
            "The phase at whose end rocks and sand are saved as bed.h5 in the run's directory, for `[[rocks]] from` "
            "and `[[terrain]] from` of other scenes. Named bodies are not saved. What still moves is saved at rest "
            "where "
            "it is: forces in equilibrium to 1 % are no rest yet, so end the phase by `duration`, long enough for "
            "kinetic_bodies in timeseries.h5 to have fallen by many decades (under damping it falls at a steady rate).",
            "no bed is saved"),
    };
}

Keys<CheckpointOptions> checkpoint_keys()
{
    return {
        optional("every_wall", "s", &CheckpointOptions::every_wall, zero_or(interval()),
                 "Wall time between checkpoints; 0: never for that."),
        optional("every_time", "s", &CheckpointOptions::every_time, zero_or(interval()),
                 "Simulated time between checkpoints; 0: never for that."),
        optional("every_steps", "", &CheckpointOptions::every_steps, integer<std::int64_t>(0, 1'000'000'000'000),
                 "Steps between checkpoints; 0: never for that."),
        optional("keep", "", &CheckpointOptions::keep, integer<std::int64_t>(1, 10'000),
                 "How many of the newest checkpoints stay."),
    };
}

Keys<Balance> balance_keys()
{
    return {
        optional("threshold", "", &Balance::threshold, number(above_up_to(1, 1e6)),
                 "The largest predicted work of a rank over the mean, beyond which pages are given to other ranks, "
                 "if that is predicted to save more than it costs."),
        optional("least_load", "points", &Balance::least_load, number_or("auto", between(0, 1e12)),
                 "Work of a rank that takes as long as any smaller one, so that it is not divided further. \"auto\" "
                 "is 500000 on a GPU, whose launches take as long as so many points, and 0 on a CPU.")};
}

Keys<Sleep> sleep_keys()
{
    const auto given = [](const Sleep& sleep) { return sleep.distance.has_value(); };
    const auto rocks = [](const Sleep& sleep) { return sleep.rock_speed.has_value(); };
    return {
        optional("distance", "m", &Sleep::distance, number_or("", above_up_to(0, 1e5)),
                 "Sand falls asleep, page by page, only further than this from the bounding sphere of every body, and "
                 "wakes when one comes nearer. Rocks that may sleep, too, follow it instead.",
                 "no sand sleeps"),
        optional("speed", "m/s", &Sleep::speed, number(speed()),
                 "A page is at rest while no point in it is faster. One that is not keeps two pages all around awake.")
            .when("distance given", given),
        optional("rest", "s", &Sleep::rest, number(span_of_time()),
                 "Simulated time for which a page must have been at rest before it falls asleep, and between looks.")
            .when("distance given", given),
        optional("load", "", &Sleep::load, number(above_up_to(0, 1e6)),
                 "A sleeping page wakes when the pressure that the sand beside it holds it with changes by this share "
                 "of the bed's weight over the area of the domain's floor.")
            .when("distance given", given),
        optional("rock_speed", "m/s", &Sleep::rock_speed, number_or("", speed()),
                 "Rocks fall asleep when no point of them or of any body beside them has gone further in `rock_rest` "
                 "than at this speed on a straight way, and wake when a body that does comes near.",
                 "no rock sleeps"),
        optional("rock_rest", "s", &Sleep::rock_rest, number(span_of_time()),
                 "Simulated time for which a rock and all beside it must have been at rest before it falls asleep, and "
                 "over which loads on sleeping rocks are averaged.")
            .when("rock_speed given", rocks),
        optional("rock_load", "", &Sleep::rock_load, number(above_up_to(0, 1e6)),
                 "A sleeping rock wakes when the mean of all forces on it changes by this share of the load that it "
                 "carried when it fell asleep, half the sum of the forces on it.")
            .when("rock_speed given", rocks),
    };
}

Keys<Reference> reference_keys()
{
    return {
        optional("form", "", &Reference::form, word<ReferenceForm>(),
                 "A closed form whose answer follows from the scene, which has to be of its kind."),
        optional(
            "file", "", &Reference::file, path(),
            "A CSV of a first column `time` (s) and others named as quantities of a study (`torque`, `sinkage` ...). A "
            "relative path starts at the scene file.",
            "no file")
            .when("form = \"none\"", [](const Reference& reference) { return reference.form == ReferenceForm::none; }),
    };
}

} // namespace tread::scene
