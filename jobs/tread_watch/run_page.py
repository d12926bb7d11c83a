"""The page of one run: progress, curves, answers, verdict, the newest picture, the end of the log."""

import numpy as np

from tread_jobs.files import number_of, printable
from tread_jobs.status import DONE
from tread_post.page import escape, headline_paragraph, paragraph, preformatted, section, table
from tread_post.run import DAMAGE, Run, RunError, words_of
from tread_post.verdict import UNKNOWN, resolution_of
from tread_watch.plots import Band, Curve, legend, plot
from tread_watch.progress import inside, log_lines, state_of

MOST_CURVES = 7  # bodies in one frame
PICTURES = {".png": "image/png", ".jpg": "image/jpeg", ".gif": "image/gif"}
LARGEST_PICTURE = 30_000_000  # bytes
FILES = ("scene.toml", "timeseries.h5")
AXES = {"time": "time  [s]", "travel": "distance from the start  [m]"}
# Frames: name, unit, and the values of a body's table.
FRAMES = (
    ("drawbar pull", "N", lambda body: body["drawbar_pull"]),
    ("torque on the axle", "N m", lambda body: -body["torque"][:, 1]),
    ("sinkage", "m", lambda body: body["sinkage"]),
    ("load", "N", lambda body: body["force"][:, 2]),
)
ANSWERS = ("pull", "torque", "sinkage", "load", "slip", "power")


def run_title(folder):
    """Title of a run's scene, else the name of the run directory."""
    try:
        return printable(_run(folder).title)
    except DAMAGE:
        return printable(folder.name)


def run_parts(folder, along):
    """(short text of the progress, pieces of HTML) of a run directory; `along` is one of AXES."""
    state = state_of(folder)
    parts = [_progress(state), _part("Curves", lambda: _curves(folder, along)), _part("Answers", lambda: _answers(state.summary)),
             _part("Verdict", lambda: _verdict(state.summary)), _picture(folder), _log(state.lines)]
    return short_text(state), [part for part in parts if part]


def short_text(state):
    """"41 %" while a run goes on, then how it ended."""
    return state.state if state.summary or not state.progress else state.progress.percent


def newest_picture(folder):
    """Path of the picture in a run directory that was written last; None without one."""
    found = [path for name in _names(folder) if (path := inside(folder, name)) and path.stat().st_size <= LARGEST_PICTURE]
    return max(found, key=lambda path: path.stat().st_mtime, default=None)


def last_answer(summary):
    """The last entry of summary.json's answers that has a pull, else the last one; None without any."""
    entries = [entry for body in summary.get("answers", {}).values() for entry in body]
    return next((entry for entry in reversed(entries) if "pull" in entry), entries[-1] if entries else None)


def mean_text(entry, name):
    """The mean of an answer with its standard error and unit; empty where there is none."""
    if not entry or name not in entry:
        return ""
    mean, error = (number_of(entry[name][part]) for part in ("mean", "standard_error"))
    unit = "" if entry[name]["unit"] == "1" else f" {entry[name]['unit']}"
    return f"{mean:.4g}{unit}" if np.isnan(error) else f"{mean:.4g} ± {error:.2g}{unit}"


def _run(folder):
    for name in FILES:
        if (folder / name).exists() and inside(folder, name) is None:
            raise RunError(f"{name}: is no regular file of the run directory")
    return Run(folder)


def _part(title, make):
    """A section; a sentence where the files are damaged or not there yet."""
    try:
        content = make()
    except DAMAGE as error:
        content = paragraph(printable(f"Cannot be read: {words_of(error)}"))
    return section(title, content) if content else ""


def _progress(state):
    share = 1.0 if state.state == DONE else state.progress.share if state.progress else 0.0
    text = f"{state.state}: {state.reason}" if state.reason else state.state
    lines = [headline_paragraph(text), f'<progress max="1" value="{share:.4f}"></progress>']
    if state.progress and not state.summary:
        lines.append(paragraph(f"{state.progress.percent} · at most {state.progress.left} left · {state.progress.text}"))
    return "\n".join(lines)


def _curves(folder, along):
    run = _run(folder)
    if not (folder / "timeseries.h5").exists():
        return paragraph("There is no time series yet.")
    tables = {name: run.wheel(name) for name in run.wheels}
    touched = [name for name, body in tables.items() if np.any(body["force"] != 0)] or list(tables)
    shown = touched[:MOST_CURVES]
    bands = _bands(run, max((body["time"][-1] for body in tables.values() if len(body["time"])), default=0.0)) if along == "time" else ()
    frames = [plot(title, unit, [Curve(name, _axis(tables[name], along), values(tables[name])) for name in shown], AXES[along], bands)
              for title, unit, values in FRAMES]
    if not any(frames):
        return paragraph("There are no rows of a body yet." if tables else "The scene has no named bodies.")
    left_out = paragraph(f"Not drawn: {', '.join(map(printable, touched[MOST_CURVES:]))}.") if len(touched) > MOST_CURVES else ""
    links = " · ".join(name if name == along else f'<a href="?against={name}">{name}</a>' for name in AXES)
    return f'<p>Against {links}.</p>{legend(map(printable, shown))}<div class="frames">{"".join(frames)}</div>{left_out}'


def _axis(body, along):
    return body["time"] if along == "time" else np.linalg.norm(body["position"][:, :2] - body["position"][:1, :2], axis=1)


def _bands(run, end):
    phases = run.phases
    ends = [phase.start for phase in phases[1:]] + [end]
    return [Band(printable(phase.name), phase.start, stop) for phase, stop in zip(phases, ends)]


def _answers(summary):
    if not summary:
        return ""
    rows = [[printable(body), printable(entry["phase"]), *(mean_text(entry, name) for name in ANSWERS), "yes" if entry.get("steady") else "no"]
            for body, entries in summary.get("answers", {}).items() for entry in entries]
    return table(("body", "phase", *ANSWERS, "steady"), rows) if rows else ""


def _verdict(summary):
    if not summary:
        return ""
    resolution = resolution_of(summary)
    if resolution.verdict == UNKNOWN:
        return paragraph("This run has no verdict.")
    lines = [f'<p class="headline {escape(resolution.verdict)}">{escape(printable(resolution.verdict))}</p>']
    lines += [paragraph(printable(text)) for text in (resolution.worst_figure, *resolution.warnings) if text]
    return "\n".join(lines)


def _names(folder):
    return [path.name for path in folder.glob("*") if path.suffix in PICTURES]


def _picture(folder):
    path = newest_picture(folder)
    if path is None:
        return ""
    name = escape(printable(path.name))
    return section("Last picture", f'<figure><img alt="{name}" src="picture?{path.stat().st_mtime_ns}"><figcaption>{name}</figcaption></figure>')


def _log(lines):
    return section("End of the log", preformatted("\n".join(lines))) if lines else ""


def waiting_parts(case):
    """(short text, pieces of HTML) of a case without a run directory."""
    return "not begun", [headline_paragraph("This case has no run yet."), _log(log_lines(case, "output.txt"))]
