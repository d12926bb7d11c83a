"""What a calibration leaves: calibration.json, its text, and samples of the constants as a campaign file."""

import numpy as np

from tread_jobs.calibration_plan import campaign_text
from tread_jobs.files import printable

ALIKE = 0.95  # size of a correlation from which on two constants are named as hardly told apart
LEVEL = 0.95


def report_of(fit, parameters, curves, scene):
    """The dictionary that calibration.json holds."""
    low, high = fit.interval(LEVEL)
    places = np.cumsum([0] + [len(curve.places) for curve in curves])
    return {
        "scene": str(scene), "rounds": fit.rounds, "settled": fit.settled, "scatter": fit.scatter, "degrees_of_freedom": fit.degrees, "level": LEVEL,
        "parameters": [{"key": parameter.key, "value": float(parameter.value(fit.unknowns[i])), "low": float(parameter.value(low[i])),
                        "high": float(parameter.value(high[i])), "bounds": [parameter.low, parameter.high], "scale": parameter.scale,
                        "at_bound": fit.at_bound[i]} for i, parameter in enumerate(parameters)],
        "correlation": fit.correlation.tolist(),
        "curves": [{"file": str(curve.path), "x": curve.x, "y": curve.y, "places": curve.places.tolist(), "measured": curve.values.tolist(),
                    "deviations": [None if np.isnan(value) else float(value) for value in curve.deviations],
                    "residuals": fit.residuals[first:last].tolist()} for curve, first, last in zip(curves, places, places[1:])],
    }


def report_text(report):
    """The same for readers."""
    lines = [f"{'constant':36} {'value':>12} {'95 % interval':>26}   bounds"]
    for parameter in report["parameters"]:
        bound = "  at its bound" if parameter["at_bound"] else ""
        low, high = parameter["bounds"]
        interval = f"{parameter['low']:.5g} to {parameter['high']:.5g}"
        lines.append(f"{parameter['key']:36} {parameter['value']:12.6g} {interval:>26}   {low:g} to {high:g}{bound}")
    lines += _correlations(report)
    given = report["curves"][0]["deviations"][0] is not None
    what = "of the measured deviations" if given else "of the largest measured value"
    lines.append(f"residuals: {report['scatter']:.3g} {what}, {report['degrees_of_freedom']} degrees of freedom; {report['rounds']} rounds")
    if not report["settled"]:
        lines.append("not settled: the best constants still moved in the last round; --rounds allows more")
    return printable("\n".join(lines)) + "\n"


def _correlations(report):
    keys, lines = [parameter["key"] for parameter in report["parameters"]], []
    for i, row in enumerate(report["correlation"]):
        for j in range(i):
            note = ": the data hardly tell them apart" if abs(row[j]) > ALIKE else ""
            lines.append(f"correlation of {keys[j]} and {keys[i]}: {row[j]:+.3f}{note}")
    return lines


def samples_text(options, parameters, unknowns):
    """A campaign file with a case for each sample; equal ones, as a walk that stays leaves them, stand once."""
    points = [tuple(parameter.value(unknown) for parameter, unknown in zip(parameters, row)) for row in unknowns]
    resources = {"backend": options.backend, "threads": options.threads, "gpus": 1 if options.backend == "cuda" else 0}
    title = f"Constants of {options.scene.stem} that the measured curves allow"
    return campaign_text(title, options.scene.resolve(), options.settings, parameters, list(dict.fromkeys(points)), resources)
