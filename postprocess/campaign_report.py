#!/usr/bin/python3
"""A campaign on one HTML page that needs nothing else: axes, answers of all cases, figures, failures, provenance.

Needs Debian's python3-h5py, python3-numpy and python3-matplotlib.
"""

import argparse
import os
import sys
from collections import Counter
from pathlib import Path

import numpy as np

import drives
import sinkage_slip
import slices
import slip_curves
from tread_post import RunError
from tread_post.campaign import CampaignTable
from tread_post.page import figure, headline_paragraph, page, paragraph, preformatted, section, table
from tread_post.run import DAMAGE, words_of
from tread_post.style import readable, with_unit
from tread_post.verdict import ESTIMATED_ERRORS, FAILED, headline, text_of

MOST_SLICES = 2  # runs whose sections are shown
# Columns of the table of answers, as far as slip is no axis. What follows from the axes is in campaign.csv.
SHOWN = ("slip", "drawbar_pull", "torque", "sinkage", "power_number")
OF_CURVES = ("Against slip. Markers: the runs' verdicts; a ring where the drive is not steady. Bars: standard deviation over the steady "
             "part. Bands: Wong and Reece's formulas with the strength of the scene's sand and the stiffness, exponent and shear length of published soils; dashed: those soils.")
OF_DRIVES = ("The drives against time, from the end of their ramps. Markers: from where the means are taken, by the runs' verdicts; a ring where "
             "the drive is not steady from there on.")
PROVENANCE = ("version", "commit", "backend", "devices", "ranks", "start", "end", "scene_hash")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("campaign", type=Path, metavar="DIR", help="of a campaign, after `jobs/campaign.py collect`")
    parser.add_argument("--output", type=Path, metavar="FILE.html", help="default: DIR/report.html")
    return parser.parse_args()


def verdict_of(campaign):
    """The first line of the page."""
    lines = [headline_paragraph(headline(campaign.verdicts))]
    if "verdict" not in campaign.columns:
        lines.append(paragraph("This table is older than verdicts: `jobs/campaign.py collect` adds them."))
    return "\n".join(lines)


def summary_of(campaign):
    counts = Counter(campaign["state"])
    states = ", ".join(f"{count} {state}" for state, count in counts.most_common())
    lines = [paragraph(f"{len(campaign)} cases: {states}. Collected {campaign.collected}.")]
    if "wall_s" in campaign.columns:
        wall = np.nansum(campaign["wall_s"])
        cost = campaign.cost
        hours = cost["gpu_hours"] or cost["core_hours"]
        lines.append(paragraph(f"Finished runs took {wall:.4g} s ({wall / 3600:.3g} h) of wall time together; expected were at most {hours:.3g} "
                               f"{'GPU' if cost['gpu_hours'] else 'core'}-hours by the model."))
    if "steady" in campaign.columns:
        judged = np.isfinite(campaign["steady"])
        lines.append(paragraph(f"{int(campaign['steady'][judged].sum())} of {judged.sum()} drives became steady."))
    return section("In short", *lines)


def axes_of(campaign):
    rows = [(axis.name, ", ".join(axis.labels), axis.unit if axis.unit != "1" else "", ", ".join(axis.keys)) for axis in campaign.axes]
    return section("Axes", table(("axis", "values", "unit", "keys of the scene"), rows))


def answers_of_all(campaign):
    """Every case: verdict, axes, means with spreads, and whether they are of a steady state."""
    labels = campaign.label_columns
    quantities = [name for name in SHOWN if name in campaign.columns and not (name == "slip" and campaign.slip_axes)]
    head = ["case", *(key.partition("/")[2] for key in labels), "state", "verdict", "worst figure", "steady"]
    head += [with_unit(name.replace("_", " "), readable(campaign[name], campaign.units[name])[1]) for name in quantities]
    errors = [name for name in (*ESTIMATED_ERRORS, "momentum_error", "energy_error", "warnings") if name in campaign.columns]
    head += [f"{name.replace('_', ' ')}{' (estimated)' if name in ESTIMATED_ERRORS else ''}" for name in errors]
    rows = []
    for row in range(len(campaign)):
        cells = [f"{int(campaign['number'][row]):04}", *(campaign[key][row] for key in labels), campaign["state"][row], text_of(campaign.verdicts[row]),
                 campaign.columns.get("worst_figure", {row: ""})[row], steadiness(campaign, row)]
        cells += [mean_and_spread(campaign, name, row) for name in quantities]
        cells += [campaign[name][row] if name in (*ESTIMATED_ERRORS, "warnings") else short(campaign[name][row]) for name in errors]
        rows.append(cells)
    kinds = [campaign.verdicts[row] if campaign["state"][row] == "done" else "not-done" for row in range(len(campaign))]
    note = paragraph("Means and standard deviations over the steady part of the last drive. Where no steady part was found: over its last half. "
                     "Verdict: how well the run was resolved, by its worst figure (docs/verdict.md).")
    return section("Answers", note, table(head, rows, kinds))


def short(number):
    return "" if np.isnan(number) else f"{number:.1e}"


def steadiness(campaign, row):
    if "steady" not in campaign.columns or np.isnan(campaign["steady"][row]):
        return ""
    return f"{'yes' if campaign['steady'][row] else 'no'}, from {campaign['steady_from'][row]:.2f} s"


def mean_and_spread(campaign, name, row):
    """Both to the place of the spread's second digit; no spread where only rounding is left."""
    factor, _ = readable(campaign[name], campaign.units[name])
    mean, spread = factor * campaign[name][row], factor * campaign[f"{name}_spread"][row]
    if np.isnan(mean):
        return ""
    if spread <= 1e-9 * max(abs(mean), 1e-3):
        return f"{mean:.4g}"
    places = max(0, 1 - int(np.floor(np.log10(spread))))
    return f"{mean:.{places}f} ± {spread:.{places}f}"


def figures_of(campaign):
    """What can be drawn; of what cannot, why."""
    parts = []
    if "torque" in campaign.columns and np.isfinite(campaign["torque"][campaign.verdicts != FAILED]).any():
        figures = (("The drives against time", drives_of),)
        if campaign.slip_axes:
            figures = (("The curves against slip", curves_of), *figures, ("Sinkage against slip", sinkage_of))
        parts = [drawn(name, draw, campaign) for name, draw in figures]
    for row in rows_with_snapshots(campaign)[:MOST_SLICES]:
        parts.append(drawn(f"Case {int(campaign['number'][row]):04}", slice_of, campaign, row))
    return section("Figures", *(filter(None, parts) if any(parts) else [paragraph("Nothing to draw yet.")]))


def drawn(name, draw, *of):
    """What `draw` gives: a figure, or an empty text where there is nothing to draw. Where files are damaged, a sentence that says so."""
    try:
        return draw(*of)
    except DAMAGE as error:
        return paragraph(f"{name} cannot be drawn: {words_of(error)}")


def curves_of(campaign):
    return figure(slip_curves.figure_of(campaign), OF_CURVES)


def drives_of(campaign):
    return figure(drives.figure_of(campaign), OF_DRIVES) if drives.groups_of(campaign) else ""


def sinkage_of(campaign):
    traces = sinkage_slip.traces_of(campaign.path)
    return figure(sinkage_slip.figure_of(traces), "Sinkage over the largest of its curve against slip.") if traces else ""


def slice_of(campaign, row):
    run = campaign.run(row)
    numbers = slices.chosen_snapshots(run)
    at = slices.default_place(run, slices.PLANES["y"][0], numbers[0])
    return figure(slices.figure_of(run, ("y", at), numbers), f"Case {int(campaign['number'][row]):04}: sand and bodies on the plane of the wheel.")


def rows_with_snapshots(campaign):
    rows = []
    for row in range(len(campaign)):
        try:
            if campaign.run(row).points_times:
                rows.append(row)
        except DAMAGE:
            continue
    return rows


def warnings_of(campaign):
    """What `check` and the runs warned of, each sentence once with the cases that it was said of."""
    cases = {}
    for row, text in enumerate(campaign.columns.get("warning_text", ())):
        for line in filter(None, text.split("\n")):
            cases.setdefault(line, []).append(f"{int(campaign['number'][row]):04}")
    parts = [paragraph(f"{line} ({', '.join(numbers)})") for line, numbers in cases.items()]
    return section("Warnings", *(parts or [paragraph("None.")]))


def failures_of(campaign):
    parts = []
    for row in np.flatnonzero(campaign["state"] != "done"):
        parts.append(paragraph(f"{int(campaign['number'][row]):04}: {campaign['state'][row]} {campaign['reason'][row]}"))
        if campaign["tail"][row]:
            parts.append(preformatted(campaign["tail"][row]))
    return section("Not done", *(parts or [paragraph("Every case is done.")]))


def provenance_of(campaign):
    keys = [key for name in PROVENANCE if (key := f"provenance/{name}") in campaign.columns]
    restarts = campaign.columns.get("restarts", np.full(len(campaign), np.nan))
    rows = [[f"{int(campaign['number'][row]):04}", *(campaign[key][row] for key in keys), restarts[row]] for row in range(len(campaign))]
    return section("Provenance", table(["case", *(key.partition("/")[2].replace("_", " ") for key in keys), "restarts"], rows),
                   paragraph("The campaign file:"), preformatted(campaign.text))


def report_of(campaign):
    return page(campaign.title, [verdict_of(campaign), summary_of(campaign), answers_of_all(campaign), warnings_of(campaign), figures_of(campaign),
                                 axes_of(campaign), failures_of(campaign), provenance_of(campaign)])


def replace(path, page_text):
    """Replaces the page in one step: who reads it finds the old one or the new one. What UTF-8 cannot hold becomes a question mark."""
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        temporary.write_text(page_text, encoding="utf-8", errors="replace")
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def main():
    options = arguments()
    campaign = CampaignTable(options.campaign)
    output = options.output or options.campaign / "report.html"
    replace(output, report_of(campaign))
    print(output)


if __name__ == "__main__":
    try:
        main()
    except RunError as error:
        sys.exit(f"campaign_report: {error}")
