"""The force of the drop against the substeps in a step, at its largest and at rest: the paper's Fig. 11."""

from tread_paper.measures import Absent
from tread_post.style import COLOURS, MARKERS, figure_grid, finish

NUMBERS = (1, 2, 5, 10, 20, 50, 100, 200)
READINGS = (("wheel_drop_substeps", "points move with the bodies (default)"), ("wheel_drop_substeps_frozen", "points stand still (the paper's)"))
AT_REST = ("wheel_drop_rest", "small twin, points stand still")
TOP = 1.25  # of both axes


def substep_figure(paper):
    figure, axes = figure_grid(1, 2, 13.0, 4.8)
    for (name, label), colour, marker in zip(READINGS, COLOURS, MARKERS):
        # Of a run that stopped before the wheel touched, as that of one substep does at this step, there is no force.
        peaks = {number: peak for number, peak in _found(paper.measures, name, "max lift_share").items() if peak > 0}
        if peaks:
            first = peaks[min(peaks)]
            axes[0, 0].plot(list(peaks), [peak / first for peak in peaks.values()], color=colour, marker=marker, label=label)
    rests = _found(paper.measures, AT_REST[0], "mean lift_share end-0.2 end")
    if not axes[0, 0].lines:
        raise Absent("no run of wheel_drop_substeps")
    axes[0, 1].plot(list(rests), list(rests.values()), color=COLOURS[1], marker=MARKERS[1], label=AT_REST[1])
    axes[0, 0].set(xscale="log", xlabel="substeps a step", ylabel="largest force over that of the fewest substeps", ylim=(0, TOP))
    axes[0, 1].set(xscale="log", xlabel="substeps a step", ylabel="force over the weight, last 0.2 s", ylim=(0, TOP))
    for axis in axes.flat:
        axis.legend(edgecolor="none", loc="lower right")
        finish(axis)
    figure.suptitle("Section 3.2: substeps (Fig. 11)", fontsize=14)
    return figure


def _found(measures, name, what):
    """Returns a measure of the runs that exist, by number of substeps."""
    found = {}
    for number in NUMBERS:
        try:
            found[number] = measures(f"{name}_{number} {what}")
        except Absent:
            continue
    return found
