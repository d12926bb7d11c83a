"""The peak force of the drop against the substeps in a step: the paper's Fig. 11."""

from tread_paper.measures import Absent
from tread_post.style import COLOURS, MARKERS, figure_grid, finish

NUMBERS = (1, 2, 5, 10, 20, 50, 100, 200)
READINGS = (("wheel_drop_substeps", "points move with the bodies (default)"), ("wheel_drop_substeps_frozen", "points stand still (the paper's)"))


def substep_figure(paper):
    figure, axes = figure_grid(1, 2, 13.0, 4.8)
    drawn = 0
    for (name, label), colour, marker in zip(READINGS, COLOURS, MARKERS):
        # Of a run that stopped before the wheel touched, as that of one substep does at this step, there is no force.
        peaks = {number: peak for number, peak in _asked(paper.measures, name, "max lift_share").items() if peak > 0}
        rests = {number: rest for number, rest in _asked(paper.measures, name, "quiet_mean").items() if number in peaks}
        if not peaks:
            continue
        drawn += 1
        first = peaks[min(peaks)]
        axes[0, 0].plot(list(peaks), [peak / first for peak in peaks.values()], color=colour, marker=marker, label=label)
        axes[0, 1].plot(list(rests), list(rests.values()), color=colour, marker=marker, label=label)
    if not drawn:
        raise Absent("no run of wheel_drop_substeps")
    axes[0, 0].set(xscale="log", xlabel="substeps a step", ylabel="largest force over that of the fewest substeps", ylim=(0, None))
    axes[0, 1].set(xscale="log", xlabel="substeps a step", ylabel="force at the end over the weight", ylim=(0, None))
    axes[0, 0].legend(edgecolor="none")
    for axis in axes.flat:
        finish(axis)
    figure.suptitle("Section 3.2: substeps (Fig. 11)", fontsize=14)
    return figure


def _asked(measures, name, what):
    """Returns a measure of the runs that exist, by number of substeps."""
    found = {}
    for number in NUMBERS:
        run = f"{name}_{number}"
        try:
            if what == "quiet_mean":
                end = measures(f"{run} summary driven")
                found[number] = measures(f"{run} mean lift_share {0.8 * end} {end}")
            else:
                found[number] = measures(f"{run} {what}")
        except Absent:
            continue
    return found
