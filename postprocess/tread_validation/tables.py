"""The page of a validation: a table of deviations and the values of each set, from stored rows and measured data alone."""

import numpy as np

from tread_validation.compare import deviation, sensitivity, tread_answers

BEGIN, END = "<!-- written by postprocess/validation.py: begin -->", "<!-- written by postprocess/validation.py: end -->"
LOCKED = "locked"  # of a wheel that does not turn, whose slip is no number
SHOWN = {"drawbar_pull": ("pull", 1.0, "N", 2), "torque": ("torque", 1.0, "N m", 2), "sinkage": ("sinkage", 1e3, "mm", 1), "slip": ("slip", 1.0, "", 3)}


def page_text(sets, rows, pictures, theories):
    """What stands between BEGIN and END. `pictures`: {set: path from the page}, for sets that have one; `theories`: of all_predictions."""
    parts = []
    for measured_set in sets.values():
        parts += [f"### {measured_set.name}: {measured_set.title}", "", *_provenance(measured_set, rows), ""]
        if measured_set.name in pictures:
            parts += [f"![{measured_set.title}]({pictures[measured_set.name]})", ""]
        parts += [*_deviations(measured_set, rows, theories), ""]
        parts += [*_sensitivities(measured_set, rows), ""]
        for curve in measured_set.curves:
            parts += [*_values(measured_set, curve, rows, theories[measured_set.name, curve.name]), ""]
    return "\n".join(parts).rstrip() + "\n"


def _provenance(measured_set, rows):
    own = [row for row in rows if row.set == measured_set.name]
    if not own:
        return ["tread: not run yet."]
    made = sorted({f"{row.version} ({row.commit[:9]}), {row.device}" for row in own})
    return [f"tread: {len(own)} runs in cells of {_list(sorted({f'{1e3 * row.spacing:g} mm' for row in own}))};",
            *(f"{text};" for text in made[:-1]), f"{made[-1]}."]


def _list(texts):
    return ", ".join(texts)


def _deviations(measured_set, rows, theories):
    lines = ["| wheel | quantity | by | points | mean deviation | mean size | largest | at |", "|---|---|---|---|---|---|---|---|"]
    for curve in measured_set.curves:
        places = curve.measured.column(measured_set.against)
        for quantity in measured_set.quantities:
            answers = tread_answers(measured_set, curve, quantity, rows)
            told = theories[measured_set.name, curve.name]
            values = {"tread": answers.value} | {name: theory[quantity].value for name, theory in told.items()}
            for name, found in values.items():
                lines.append(_deviation_line(measured_set, curve, quantity, name, deviation(places, found, curve.measured.column(quantity))))
    return lines


def _deviation_line(measured_set, curve, quantity, name, found):
    _, factor, _, digits = SHOWN[quantity]
    head = f"| {curve.name} | {_head(quantity)} | {name} |"
    if found is None:
        return f"{head} 0 | {'not run yet' if name == 'tread' else '-'} | | | |"
    numbers = [f"{factor * value:+.{digits}f}" for value in (found.bias,)] + [f"{factor * found.mean:.{digits}f}", f"{factor * found.largest:+.{digits}f}"]
    return f"{head} {found.points} | {' | '.join(numbers)} | {_place(measured_set, found.at)} |"


def _sensitivities(measured_set, rows):
    """What an assumption changes, as the mean over the measured points."""
    heads = [_head(quantity) for quantity in measured_set.quantities]
    lines = [f"| wheel: assumed instead | points | {' | '.join(f'change of {head}' for head in heads)} |", "|" + "---|" * (2 + len(heads))]
    for curve in measured_set.curves:
        for what, (points, change) in sorted(sensitivity(measured_set, curve, rows).items()):
            numbers = [f"{SHOWN[name][1] * value:+.{SHOWN[name][3]}f}" for name, value in change.items()]
            lines.append(f"| {curve.name}: {what} | {points} | {' | '.join(numbers)} |")
    return lines if len(lines) > 2 else []


def _head(quantity):
    label, _, unit, _ = SHOWN[quantity]
    return f"{label}{f' [{unit}]' if unit else ''}"


def _place(measured_set, value):
    if np.isnan(value):
        return LOCKED
    return f"slip {value:g}" if measured_set.against == "slip" else f"{value:g} degrees"


def _values(measured_set, curve, rows, theories):
    places = curve.measured.column(measured_set.against)
    unit = "slip" if measured_set.against == "slip" else "slope [degrees]"
    lines = [f"| {curve.name}: {unit} | quantity | measured | tread | band of what is assumed | {' | '.join(theories)} | verdict of tread |",
             "|" + "---|" * (6 + len(theories))]
    for quantity in measured_set.quantities:
        answers = tread_answers(measured_set, curve, quantity, rows)
        for point in range(len(places)):
            lines.append(_value_line(measured_set, curve, quantity, point, answers, theories))
    return lines


def _value_line(measured_set, curve, quantity, point, answers, theories):
    _, factor, _, digits = SHOWN[quantity]
    place = curve.measured.column(measured_set.against)[point]

    def shown(value):
        return "-" if np.isnan(value) else f"{factor * value:.{digits}f}"

    def with_error(value, error):
        return shown(value) + ("" if np.isnan(error) or np.isnan(value) else f" +- {shown(error)}")

    cells = [f"{place:g}" if np.isfinite(place) else LOCKED, _head(quantity),
             with_error(curve.measured.column(quantity)[point], curve.measured.column(f"{quantity}_spread")[point]),
             with_error(answers.value[point], answers.grid[point]),
             f"{shown(answers.low[point])} to {shown(answers.high[point])}" if answers.low[point] < answers.high[point] else "-",
             *(shown(theory[quantity].value[point]) for theory in theories.values()), answers.verdict[point] or "-"]
    return f"| {' | '.join(cells)} |"


def replaced(page, text):
    """The page with `text` between its marks; ValueError where it has none."""
    before, begin, rest = page.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise ValueError(f"the lines '{BEGIN}' and '{END}' are missing")
    return f"{before}{BEGIN}\n\n{text}\n{END}{after}"
