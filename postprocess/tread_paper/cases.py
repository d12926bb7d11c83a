"""The figures of each case: name of the picture, its caption, and what draws it from stored runs."""

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


def histories(paper, named):
    """(label, [History of each repeat]) of the runs that are there; Absent where none is."""
    found = []
    for name, label in named:
        runs = paper.repeats(name)
        if runs:
            found.append((f"{label} ({text_of(resolution_of(runs[0].summary).verdict)})", [history_of(run) for run in runs]))
    if not found:
        raise Absent(f"none of {', '.join(name for name, _ in named)} was run")
    return found


def impact(paper):
    runs = [paper.run(name) for name in ("head_on_1", "head_on_8", "head_on_27")]
    all_of = [head_on.history_of(run) for run in runs]
    time = np.linspace(0, all_of[0].time[-1], 2001)
    return head_on.figure_of(all_of, [head_on.hertz(runs[0].scene, spheres, time) for spheres in (1, 2)])


DROPS = (("wheel_drop_sand", "sand"), ("wheel_drop_mixed", "sand and rocks"), ("wheel_drop_rock", "rocks, the paper's 300,000 of 10 mm"),
         ("wheel_drop_rock_filled", "rocks of 16 mm that fill the box"))


def drop(paper):
    weight = ((1.0, "weight"),)
    panels = (Panel("lift_share", "force over weight", lines=weight), Panel("lift_share", "force over weight", lines=weight, limits={"ylim": (0, 3)}),
              Panel("rise", "height, from the release"), Panel("vertical_speed", "vertical speed"))
    return figure_of("Section 3.2: the wheel falls 0.7 m (Fig. 10 d)", histories(paper, DROPS), panels)


def last_of(label, history):
    """(label, run, number) of the last snapshot with displacements. The label says since when the last phase began, where that phase went on."""
    run = history.run
    number = fields.last_snapshot(run)
    since = (run.points(number) or run.bodies(number)).time - history.start
    return (f"{label}, at {since:.1f} s" if since < history.time[-1] - 0.05 else label), run, number


def at_the_end(title, named):
    """Displacement in the last snapshot of each run that has any."""
    def draw(paper):
        with_any = [(label, [one for one in repeats if one.run.snapshots]) for label, repeats in histories(paper, named)]
        shown = [last_of(label, repeats[0]) for label, repeats in with_any if repeats]
        if not shown:
            raise Absent(f"no snapshots of {', '.join(name for name, _ in named)}")
        return fields.figure_of(title, shown, common_scale=False)
    return draw


ROLLS = (("rolling_sand", "sand"), ("rolling_mixed", "sand and rocks"), ("rolling_rocks", "irregular rocks"), ("rolling_spheres", "spheres"),
         ("rolling_sand_coarse", "sand, coarse"), ("rolling_mixed_coarse", "sand and rocks, coarse"), ("rolling_rocks_coarse", "irregular rocks, coarse"),
         ("rolling_spheres_coarse", "spheres, coarse"))


def roll(paper):
    panels = (Panel("speed", "speed", 0.2, lines=((0.13, "omega R"), (0.0975, "a quarter less"))),
              Panel("torque", "torque", 0.2, lines=((80.0, "paper, sand"), (170.0, "paper, rocks"))),
              Panel("rise", "height, from the start of the drive"), Panel("way", "way"))
    return figure_of("Section 3.3: rolling at 0.5 rad/s, 9.8 m/s2 (Fig. 14); thin: repeats", histories(paper, ROLLS), panels)


SLIPS = (("slip_sand", "sand"), ("slip_mixed", "sand and rocks"))
SLIP_TIMES = (0.5, 1.5, 2.5)  # s, of the drive; later the end wall acts


def slip(paper):
    events = (0.5, 1.5)
    panels = (Panel("speed", "v_x", 0.02, marks=events), Panel("vertical_speed", "v_z", 0.02, marks=events), Panel("way", "way", marks=events),
              Panel("rise", "height, from the start of the drive", marks=events), Panel("pull", "F_x", 0.1, marks=events),
              Panel("torque", "torque", 0.1, lines=((49.6, "mu W R"),), marks=events))
    return figure_of("Section 3.4: slip 0.3 on Mars (Fig. 19); the paper's times 0.5 and 1.5 s are marked; thin: repeats", histories(paper, SLIPS), panels)


def nearest(run, times):
    """Numbers of the snapshots nearest to times (s) of the drive, and the start of the drive (s). Absent where the run has none of it."""
    start = history_of(run).start
    there = {number: time - start for number, time in run.points_times.items() if time > start - 0.2}
    if not there:
        raise Absent(f"{run.path.name} has no snapshots of its drive")
    return sorted({min(there, key=lambda number: abs(there[number] - time)) for time in times}), start


def slip_slices(name):
    """Slices with one scale for both terrains."""
    def draw(paper):
        numbers, start = nearest(paper.run(name), SLIP_TIMES)
        both = [paper.run(other) for other, _ in SLIPS if paper.measures.has(other) and paper.run(other).snapshots]
        norms = zip(*(slices.norms_of(run, nearest(run, SLIP_TIMES)[0]) for run in both))
        widest = [max(pair, key=lambda norm: norm.vmax) for pair in norms]
        return slices.figure_of(paper.run(name), ("y", slices.default_place(paper.run(name), 1, numbers[0])), numbers, widest, start)
    return draw


def slip_surface(paper):
    shown = []
    for name, label in SLIPS:
        if paper.measures.has(name) and paper.run(name).snapshots:
            numbers, start = nearest(paper.run(name), SLIP_TIMES[-1:])
            shown += [(f"{label}, {paper.run(name).points_times[number] - start:.2f} s", paper.run(name), number) for number in numbers]
    if not shown:
        raise Absent("slip_sand and slip_mixed have no snapshots")
    return fields.surface_figure_of("Section 3.4: the surface and the track (Fig. 16); lines: the wheel at the height of its axle", shown, (0.0, 0.2, 0.35))


SPIRITS = (("spirit", "the paper's wheel"), ("spirit_coarse", "the paper's wheel, coarse"), ("spirit_mer_coarse", "Spirit's wheel, coarse"))


def spirit(paper):
    marks = (3.0, 14.0, 35.0)
    panels = (Panel("speed", "v_x", 0.5, lines=((0.0416, "omega R"),), marks=marks), Panel("vertical_speed", "v_z", 0.5, marks=marks),
              Panel("way", "way", marks=marks), Panel("rise", "height, from the start of the drive", marks=marks),
              Panel("pull", "F_x", 0.5, marks=marks), Panel("torque_share", "torque over mu W R", 0.5, lines=((2.0, "paper"),), marks=marks))
    return figure_of("Section 4: Spirit (Fig. 22); the paper's times 3, 14 and 35 s are marked; thin: repeats", histories(paper, SPIRITS), panels)


def spirit_slip(paper):
    return sinkage_slip.figure_of([trace for _, repeats in histories(paper, SPIRITS) for trace in sinkage_slip.traces_of(repeats[0].run.path)])


def at_times(title, name, times):
    """Displacement at times (s) of the drive, close to the wheel and from above."""
    def draw(paper):
        run = paper.run(name)
        numbers, start = nearest(run, times)
        return fields.close_up_of(title, [(f"t = {run.points_times[number] - start:.1f} s", run, number) for number in numbers])
    return draw


RIPPLES = (("curiosity_rock", "rock"), ("curiosity_core", "core of sand"), ("curiosity_rock_coarse", "rock, coarse"),
           ("curiosity_core_coarse", "core of sand, coarse"))


def curiosity(paper):
    marks = (7.0, 15.0, 23.0, 42.0)
    panels = (Panel("speed", "v_x", 0.5, marks=marks), Panel("vertical_speed", "v_z", 0.5, marks=marks), Panel("way", "way", marks=marks),
              Panel("rise", "height, from the start of the drive", marks=marks), Panel("pull", "F_x", 0.5, marks=marks),
              Panel("torque", "torque", 0.5, lines=((75.0, "paper: 75"), (100.0, "100"), (200.0, "200")), marks=marks))
    found = histories(paper, RIPPLES)
    title = "Section 5: Curiosity (Fig. 26); the paper's times 7, 15, 23 and 42 s are marked; dashed: rolling without slip; thin: repeats"
    figure = figure_of(title, found, panels)
    longest = max((repeats[0] for _, repeats in found), key=lambda history: history.time[-1])
    for quantity, axis in zip(("speed", "vertical_speed"), figure.axes):
        time, values = rolled_over(longest, quantity)
        axis.plot(time, 1e3 * values if axis.get_ylabel().endswith("[mm/s]") else values, color="#444444", linestyle="--", linewidth=1.1)
    return figure


SPIRIT_TIMES, CURIOSITY_TIMES = (0, 14, 28, 42, 56), (0, 7, 15, 23, 42, 56)

FIGURES = {
    "head_on": {"head_on": ("Velocities, force, energies and their errors (Figs. 7 b, 8)", impact)},
    "wheel_drop": {
        "wheel_drop": ("Force, height and speed of the dropped wheel (Fig. 10 d)", drop),
        "wheel_drop_fields": ("Displacement at the end of the drop (Fig. 10 a to c)",
                              at_the_end("Section 3.2: displacement at the end of the drop (Fig. 10 a to c)", DROPS)),
        "wheel_drop_substeps": ("Largest force and force at the end against the number of substeps (Fig. 11)", substep_figure),
    },
    "rolling": {
        "rolling": ("Speed, torque, height and way on four terrains (Fig. 14)", roll),
        "rolling_fields": ("Displacement at the end, section and from above (Fig. 13)",
                           at_the_end("Section 3.3: displacement at the end (Fig. 13)", ROLLS)),
    },
    "slip": {
        "slip": ("Velocity, displacement, force and torque on sand and on sand with rocks (Fig. 19)", slip),
        "slip_surface": ("The surface from above and across the track (Fig. 16)", slip_surface),
        "slip_sand_slices": ("Sand: displacement and shear on the wheel's plane (Figs. 17, 18)", slip_slices("slip_sand")),
        "slip_mixed_slices": ("Sand with rocks: displacement and shear on the wheel's plane (Figs. 17, 18)", slip_slices("slip_mixed")),
    },
    "spirit": {
        "spirit": ("Velocity, displacement, force and torque of Spirit (Fig. 22)", spirit),
        "spirit_sinkage": ("Sinkage over its largest against slip, with published points (Fig. 23)", spirit_slip),
        **{f"{name}_fields": (f"Displacement in sections and from above, {label} (Fig. 21)",
                              at_times(f"Section 4: displacement (Fig. 21), {name}", name, SPIRIT_TIMES)) for name, label in SPIRITS[:2]},
    },
    "curiosity": {
        "curiosity": ("Velocity, displacement, force and torque of Curiosity (Fig. 26)", curiosity),
        **{f"{name}_fields": (f"Displacement in sections and from above, {label} (Fig. 25)",
                              at_times(f"Section 5: displacement (Fig. 25), {name}", name, CURIOSITY_TIMES)) for name, label in RIPPLES},
    },
}
