"""From the runs of a study to its table. Needs h5py and numpy, and reads runs with postprocess/tread_post."""

import functools
import math
import sys
from dataclasses import replace
from pathlib import Path

from tread_jobs.axes import label_of
from tread_jobs.errors import CampaignError, MachineError
from tread_jobs.files import number_of, printable, write_text
from tread_jobs.scene_keys import canonical, value_at
from tread_jobs.status import DONE, FAILED, CaseState, read_summary
from tread_jobs.study_plan import PERTURBATION

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "postprocess"))
try:
    from tread_post.closed_forms import FORMS
    from tread_post.quantities import QUANTITIES, default_quantities
    from tread_post.references import Variant, from_file, hub_of, judge, known_value
    from tread_post.run import DAMAGE, Run, RunError, words_of
    from tread_post.study_table import Row, study_text
    from tread_post.verdict import resolution_of
except ImportError as missing:
    raise MachineError(f"a study needs h5py, numpy and matplotlib ({missing}): Debian's python3-h5py and python3-matplotlib, with /usr/bin/python3; "
                       "TREAD_PYTHON names another interpreter") from missing


def chosen_quantities(scene, asked):
    """{name: Quantity} of the names asked for, else those of the scene's closed form, else of its kind. CampaignError for what it cannot have."""
    form = form_of(scene)
    if form:
        lacks = form.needs(scene)
        if lacks:
            raise CampaignError(f"[reference] form = \"{scene['reference']['form']}\": the scene is not of its kind, which wants {lacks}")
    known = {**QUANTITIES, **(form.quantities if form else {})}
    for name in asked:
        if name not in known:
            raise CampaignError(f"--quantities {name}: unknown; this scene has {', '.join(known)}")
        if not scene.get("body") and name in QUANTITIES and name != "energy":
            raise CampaignError(f"--quantities {name}: the scene has no [[body]]")
    return {name: known[name] for name in asked or (form.quantities if form else default_quantities(scene))}


def form_of(scene):
    """The ClosedForm that the scene names; None where it names none, or one that only `tread check` can refuse."""
    return FORMS.get(scene.get("reference", {}).get("form", "none"))


def write_table(path, directory, states, quantities, options):
    """study.csv of all variants that finished, and of the others that they did not; the states, in which those that cannot be read have failed.
    RunError if none can be compared."""
    manifest, entries = directory.manifest, directory.entries()
    keys = [axis["name"] for axis in manifest["axes"] if axis["name"] != PERTURBATION]
    quantities = {name: _measured_once(quantity) for name, quantity in quantities.items()}
    states, variants = _variants(entries, states, quantities, directory)
    hub = hub_of([variant for variant in variants if not variant.is_perturbed], options.design)
    rows = []
    for name, quantity in quantities.items():
        judged = judge(variants, quantity, _known(name, quantity, hub.run, options), options.design)
        rows += [_row(entry, keys, states[entry.name].state, directory, name, quantity, judged) for entry in entries]
    comments = _comments(manifest, options, read_summary(directory.cases / hub.name) or {})
    comments += [f"variant {name}: {state.reason}" for name, state in states.items() if state.state == FAILED]
    write_text(path, study_text([" ".join(printable(line).split()) for line in comments], keys, rows))
    return states


def _measured_once(quantity):
    """The same, but that it reads each run once."""
    return replace(quantity, measure=functools.cache(quantity.measure), noise=quantity.noise and functools.cache(quantity.noise))


def _variants(entries, states, quantities, directory):
    """States by name and Variants of those that can be read: what is damaged, or gives a quantity no answer, has failed."""
    manifest, variants, states = directory.manifest, [], dict(states)
    for entry in (entry for entry in entries if states[entry.name].state == DONE):
        try:
            _numbers(read_summary(directory.cases / entry.name) or {})
            variant = _variant(entry, manifest, directory)
            for quantity in quantities.values():
                quantity.measure(variant.run)
                if quantity.noise:
                    quantity.noise(variant.run)
            variants.append(variant)
        except DAMAGE as error:
            states[entry.name] = CaseState(FAILED, f"cannot be compared: {words_of(error)}", "")
    if not variants:
        reasons = [f"; variant {name}: {state.reason}" for name, state in states.items() if state.state == FAILED]
        raise RunError(f"{directory.path}: no variant finished that can be compared{''.join(reasons[:1])}")
    return states, variants


def _variant(entry, manifest, directory):
    run = Run(directory.cases / entry.name / "run")
    axes = {axis["name"]: axis for axis in manifest["axes"]}
    settings = {name: value_at(run.scene, canonical(run.scene, axis["keys"][0]), "default") for name, axis in axes.items() if name != PERTURBATION}
    return Variant(entry.name, settings, run, entry.is_own, _is_perturbed(entry, axes))


def _is_perturbed(entry, axes):
    return PERTURBATION in axes and entry.labels[PERTURBATION] in axes[PERTURBATION]["labels"]


def _known(name, quantity, run, options):
    """What the user says is right, else the scene's closed form or file; None where the variants have to give it."""
    if name in options.known:
        return known_value(options.known[name], 0.0, "as given")
    table = run.scene.get("reference", {})
    form = form_of(run.scene)
    if not options.finest and form and name in form.quantities:
        return known_value(form.answers(run)[name], form.uncertainty, form.text)
    told = from_file(Path(table["file"]), name, quantity, run) if table.get("file") and not options.finest else None
    return told or (known_value(quantity.right, 0.0, "no loss") if quantity.right is not None else None)


def _numbers(summary):
    """Returns the verdict and the cost of a variant from its summary.json."""
    numbers = [number_of(summary.get(name)) for name in ("points", "bodies", "steps", "substeps", "wall_s")]
    return resolution_of(summary).verdict, *numbers, number_of(summary.get("peak_device_bytes") or summary.get("peak_host_bytes"))


def _settings(entry, keys, directory):
    """What the run's own scene says of the keys; where there is none that can be read, the labels."""
    axes = {axis["name"]: axis for axis in directory.manifest["axes"]}
    try:
        scene = Run(directory.cases / entry.name / "run").scene
        return {key: label_of(value_at(scene, canonical(scene, axes[key]["keys"][0]), "default")) for key in keys}
    except (*DAMAGE, CampaignError):
        return {key: entry.labels[key] for key in keys}


def _row(entry, keys, state, directory, name, quantity, judged):
    axes = {axis["name"]: axis for axis in directory.manifest["axes"]}
    try:
        numbers = _numbers(read_summary(directory.cases / entry.name) or {})
    except DAMAGE:
        numbers = _numbers({})
    reference, scale = judged.reference, judged.scale
    share = 1.0 if math.isnan(scale) else 1 / scale if scale > 0 else math.nan
    measured = judged.measured.get(entry.name, math.nan)
    is_curve = reference.curve is not None
    return Row(
        entry.name, _settings(entry, keys, directory), entry.labels[PERTURBATION] if _is_perturbed(entry, axes) else "", state, *numbers, name, quantity.unit,
        math.nan if is_curve else measured, reference.value, reference.uncertainty * share, judged.scatter * share,
        judged.errors.get(entry.name, math.nan), reference.text, judged.noise.get(entry.name, math.nan))


def _comments(manifest, options, summary):
    devices = summary.get("devices")
    devices = ", ".join(map(str, devices)) if devices and isinstance(devices, list) else f"{summary.get('threads')} threads"
    return [manifest["title"], f"tread {summary.get('version')} ({summary.get('commit')}), {summary.get('backend')}, {devices}; {options.jobs} runs at a time",
            f"{options.design} of " + ", ".join(axis["name"] for axis in manifest["axes"]),
            "uncertainty, scatter and error are shares of what is right, or of the quantity's scale; memory is the backend's at most"]
