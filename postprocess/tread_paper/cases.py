"""The figures of each case: name of the picture, and what draws it from the runs of a directory."""

import numpy as np

import head_on
import sinkage_slip
import slices
from tread_paper import fields
from tread_paper.figures import Panel, figure_of
from tread_paper.history import history_of
from tread_paper.measures import Absent
from tread_paper.rolling import rolled_over
from tread_paper.substeps import substep_figure
from tread_post.verdict import resolution_of, text_of


def histories(measures, named):
    """(label, History) of the runs that are there; Absent where none is."""
    found = []
    for name, label in named:
        try:
            run = measures.run(name)
            found.append((f"{label} ({text_of(resolution_of(run.summary).verdict)})", history_of(run)))
        except Absent:
            continue
    if not found:
        raise Absent(f"none of {', '.join(name for name, _ in named)} was run")
    return found


def impact(measures):
    runs = [measures.run(name) for name in ("head_on_1", "head_on_8", "head_on_27")]
    all_of = [head_on.history_of(run) for run in runs]
    time = np.linspace(0, all_of[0].time[-1], 2001)
    return head_on.figure_of(all_of, [head_on.hertz(runs[0].scene, spheres, time) for spheres in (1, 2)])


DROPS = (("wheel_drop_sand", "sand"), ("wheel_drop_mixed", "sand and rocks"), ("wheel_drop_rock", "rocks, the paper's 300,000 of 10 mm"),
         ("wheel_drop_rock_filled", "rocks of 16 mm that fill the box"))


def drop(measures):
    weight = ((1.0, "weight"),)
    panels = (Panel("lift_share", "force over weight", lines=weight), Panel("lift_share", "force over weight", lines=weight, limits={"ylim": (0, 3)}),
              Panel("rise", "height, from the release"), Panel("vertical_speed", "vertical speed"))
    return figure_of("Section 3.2: the wheel falls 0.7 m (Fig. 10 d)", histories(measures, DROPS), panels)


def drop_fields(measures):
    shown = [(label, history.run, fields.last_snapshot(history.run)) for label, history in histories(measures, DROPS) if history.run.snapshots]
    return fields.figure_of("Section 3.2: displacement at the end of the drop (Fig. 10 a to c)", of_snapshots(shown), common_scale=False)


ROLLS = (("rolling_sand", "sand"), ("rolling_mixed", "sand and rocks"), ("rolling_sand_coarse", "sand, coarse"),
         ("rolling_mixed_coarse", "sand and rocks, coarse"), ("rolling_rocks_coarse", "irregular rocks, coarse"),
         ("rolling_spheres_coarse", "spheres, coarse"))


def roll(measures):
    panels = (Panel("speed", "speed", 0.2, lines=((0.13, "omega R"), (0.0975, "a quarter less"))),
              Panel("torque", "torque", 0.2, lines=((80.0, "paper, sand"), (170.0, "paper, rocks"))),
              Panel("rise", "height, from the start of the drive"), Panel("way", "way"))
    return figure_of("Section 3.3: rolling at 0.5 rad/s (Fig. 14)", histories(measures, ROLLS), panels)


def roll_fields(measures):
    shown = [(label, history.run, fields.last_snapshot(history.run)) for label, history in histories(measures, ROLLS) if history.run.snapshots]
    return fields.figure_of("Section 3.3: displacement at the end (Fig. 13)", of_snapshots(shown), common_scale=False)


SLIPS = (("slip_sand", "sand"), ("slip_mixed", "sand and rocks"))


def slip(measures):
    events = (0.5, 1.5)
    panels = (Panel("speed", "v_x", 0.02, marks=events), Panel("vertical_speed", "v_z", 0.02, marks=events), Panel("way", "way", marks=events),
              Panel("rise", "height, from the start of the drive", marks=events), Panel("pull", "F_x", 0.1, marks=events),
              Panel("torque", "torque", 0.1, lines=((49.6, "mu W R"),), marks=events))
    return figure_of("Section 3.4: slip 0.3 on Mars (Fig. 19); the paper's times 0.5 and 1.5 s are marked", histories(measures, SLIPS), panels)


def slip_slices(name):
    def draw(measures):
        run = measures.run(name)
        if not run.snapshots:
            raise Absent(f"{name} has no snapshots here")
        numbers = slices.chosen_snapshots(run)
        return slices.figure_of(run, ("y", slices.default_place(run, 1, numbers[0])), numbers)
    return draw


SPIRITS = (("spirit", "the paper's wheel"), ("spirit_coarse", "the paper's wheel, coarse"), ("spirit_mer_coarse", "Spirit's wheel, coarse"))


def spirit(measures):
    marks = (3.0, 14.0, 35.0)
    panels = (Panel("speed", "v_x", 0.5, lines=((0.0416, "omega R"),), marks=marks), Panel("vertical_speed", "v_z", 0.5, marks=marks),
              Panel("way", "way", marks=marks), Panel("rise", "height, from the start of the drive", marks=marks),
              Panel("pull", "F_x", 0.5, marks=marks), Panel("torque_share", "torque over mu W R", 0.5, lines=((2.0, "paper"),), marks=marks))
    return figure_of("Section 4: Spirit (Fig. 22); the paper's times 3, 14 and 35 s are marked", histories(measures, SPIRITS), panels)


def spirit_slip(measures):
    return sinkage_slip.figure_of([trace for _, history in histories(measures, SPIRITS) for trace in sinkage_slip.traces_of(history.run.path)])


def at_times(measures, name, title, times):
    run = measures.run(name)
    start = history_of(run).start
    there = run.points_times
    if not there:
        raise Absent(f"{name} has no snapshots here")
    there = {number: time for number, time in there.items() if time > start - 0.2}
    numbers = sorted({min(there, key=lambda number: abs(there[number] - start - time)) for time in times})
    return fields.figure_of(title, [(f"t = {there[number] - start:.1f} s", run, number) for number in numbers])


def spirit_fields(name):
    return lambda measures: at_times(measures, name, f"Section 4: displacement (Fig. 21), {name}", (0, 14, 28, 42, 56))


RIPPLES = (("curiosity_rock", "rock"), ("curiosity_core", "core of sand"), ("curiosity_rock_coarse", "rock, coarse"),
           ("curiosity_core_coarse", "core of sand, coarse"))


def curiosity(measures):
    marks = (7.0, 15.0, 23.0, 42.0)
    panels = (Panel("speed", "v_x", 0.5, marks=marks), Panel("vertical_speed", "v_z", 0.5, marks=marks), Panel("way", "way", marks=marks),
              Panel("rise", "height, from the start of the drive", marks=marks), Panel("pull", "F_x", 0.5, marks=marks),
              Panel("torque", "torque", 0.5, lines=((75.0, "paper: 75"), (100.0, "100"), (200.0, "200")), marks=marks))
    found = histories(measures, RIPPLES)
    figure = figure_of("Section 5: Curiosity (Fig. 26); the paper's times 7, 15, 23 and 42 s are marked; dashed: rolling without slip", found, panels)
    longest = max((history for _, history in found), key=lambda history: history.time[-1])
    for quantity, axis in zip(("speed", "vertical_speed"), figure.axes):
        time, values = rolled_over(longest, quantity)
        axis.plot(time, 1e3 * values if axis.get_ylabel().endswith("[mm/s]") else values, color="#444444", linestyle="--", linewidth=1.1)
    return figure


def curiosity_fields(name):
    return lambda measures: at_times(measures, name, f"Section 5: displacement (Fig. 25), {name}", (0, 7, 15, 23, 42, 56))


def of_snapshots(shown):
    if not shown:
        raise Absent("no run has snapshots here")
    return shown


TABLES_ALONE = ("method", "cost", "sensitivity", "verdicts", "round2")  # of no case

FIGURES = {
    "head_on": {"head_on": impact},
    "wheel_drop": {"wheel_drop": drop, "wheel_drop_fields": drop_fields, "wheel_drop_substeps": substep_figure},
    "rolling": {"rolling": roll, "rolling_fields": roll_fields},
    "slip": {"slip": slip, "slip_sand_slices": slip_slices("slip_sand"), "slip_mixed_slices": slip_slices("slip_mixed")},
    "spirit": {"spirit": spirit, "spirit_sinkage": spirit_slip, "spirit_fields": spirit_fields("spirit"),
               "spirit_coarse_fields": spirit_fields("spirit_coarse")},
    "curiosity": {"curiosity": curiosity, **{f"{name}_fields": curiosity_fields(name) for name, _ in RIPPLES}},
}
