"""One submission: which cases each task of the array runs, and the script that runs them, in a directory of its own."""

import json
import re
import shlex
from dataclasses import dataclass
from pathlib import Path

from tread_jobs.files import read_object, read_text, write_text

TEMPLATE = Path(__file__).resolve().parents[1] / "campaign.sbatch"


@dataclass(frozen=True)
class Submission:
    folder: Path
    tasks: list  # of lists of case names; a task's place is its number in the array
    script: str
    restarts: int

    def write(self):
        """The directory, with everything that sbatch or a shell needs."""
        (self.folder / "logs").mkdir(parents=True)
        write_text(self.folder / "tasks.txt", "".join(" ".join(task) + "\n" for task in self.tasks))
        write_text(self.folder / "campaign.sbatch", self.script)

    def record(self, how):
        """Leaves what `status` and `retry` ask for: the means and, under SLURM, the job's number."""
        write_text(self.folder / "submission.json", json.dumps(how))


def make_submission(directory, entries, resources, site, program):
    """Tasks of `resources.cases_a_task` cases each, and their script."""
    names = [entry.name for entry in entries]
    tasks = [names[first:first + resources.cases_a_task] for first in range(0, len(names), resources.cases_a_task)]
    number = 1 + max((int(folder.name) for folder in _folders(directory)), default=0)
    script = render(TEMPLATE.read_text(encoding="utf-8"), _fillings(directory, tasks, resources, site, program))
    return Submission(directory.submissions / f"{number:04}", tasks, script, resources.restarts)


def render(template, fillings):
    """The template with every __word__ filled in; KeyError for a word that has no filling."""
    return re.sub(r"__([a-z]+(?:_[a-z]+)*)__", lambda found: fillings[found[1]], template)


def past_submissions(directory):
    """(folder, tasks, how) of every submission so far, oldest first; of one whose record cannot be read, `how` is empty."""
    return [(folder, _tasks(folder), read_object(folder / "submission.json") or {})
            for folder in _folders(directory) if (folder / "submission.json").exists()]


def last_means(directory):
    """`how` of the last submission that can be read; empty where none can."""
    return next((how for _, _, how in reversed(past_submissions(directory)) if {"means", "site"} <= set(how)), {})


def _folders(directory):
    """Directories of submissions in their order. What a user has laid beside them, such as 0001.bak, is none."""
    found = [folder for folder in directory.submissions.glob("*") if re.fullmatch("[0-9]{1,9}", folder.name) and folder.is_dir()]
    return sorted(found, key=lambda folder: int(folder.name))


def _tasks(folder):
    try:
        return [line.split() for line in read_text(folder / "tasks.txt").splitlines()]
    except OSError:
        return []


def _fillings(directory, tasks, resources, site, program):
    """Everything that a shell reads is quoted; what #SBATCH lines hold was checked when it was read."""
    options = ["--restart", "auto", "--walltime-limit", resources.wall_time, "--backend", resources.backend,
               "--threads", str(resources.threads), "--quiet"]
    modules = "\n".join(f"module load {shlex.quote(module)}" for module in site.modules)
    return {
        "array": f"0-{len(tasks) - 1}%{resources.at_once}",
        "wall_time": resources.wall_time,
        "signal_lead": str(resources.signal_lead),
        "directives": "\n".join(f"#SBATCH {line}" for line in _directives(resources, site)),
        "campaign": shlex.quote(str(directory.path)),
        "command": shlex.join([*_launcher(resources, site), program]),
        "restarts": str(resources.restarts),
        "share_gpu": "yes" if resources.shares_gpu else "",
        "modules": modules,
        "options": shlex.join(options),
    }


def _launcher(resources, site):
    if resources.ranks == 1:
        return []
    if site.launcher == "srun":
        return ["srun", "--mpi=pmix"]
    return ["mpirun", "--bind-to", "none", "-n", str(resources.ranks)]


def _directives(resources, site):
    lines = [f"--nodes={resources.nodes}", f"--ntasks-per-node={resources.ranks // resources.nodes * resources.cases_a_task}",
             f"--cpus-per-task={resources.threads}"]
    if resources.gpus:
        lines += [f"--gpus-per-node={resources.gpus // resources.nodes}", "--gpu-bind=none"]
    if resources.memory_gb:
        lines.append(f"--mem={resources.memory_gb}G")
    for option in ("partition", "account", "qos", "constraint"):
        value = getattr(site, option)
        if value:
            lines.append(f"--{option}={value}")
    return lines
