"""What a case of a campaign is given, and how a site is told: [resources] of the campaign file and a file of jobs/sites."""

import re
import tomllib
from dataclasses import dataclass, field, fields
from pathlib import Path

from tread_jobs.errors import CampaignError

SITES = Path(__file__).resolve().parents[1] / "sites"
TIME = re.compile(r"([0-9]{1,4}):([0-5][0-9]):([0-5][0-9])")
# What may stand in a line of #SBATCH, which no shell ever reads, but sbatch splits at spaces.
TOKEN = re.compile(r"[A-Za-z0-9_.:,@%/+=\[\]&|*-]*")

MOST_ON_A_GPU = 48  # clients of NVIDIA's Multi-Process Service on one GPU


@dataclass(frozen=True)
class Resources:
    """Resources of one case; a task of the array runs `cases_a_task` of them side by side."""

    nodes: int = 1
    ranks: int = 1
    threads: int = 1  # CPU threads a rank
    gpus: int = 0  # of the task
    backend: str = "auto"
    wall_time: str = "04:00:00"
    signal_lead: int = 180  # s before the limit at which runs are told to write a checkpoint and stop
    restarts: int = 10  # how often a task that stopped early begins again by itself
    cases_a_task: int = 1
    at_once: int = 50  # tasks of the array that run at the same time, at most
    memory_gb: int = 0  # a node; 0 leaves it to the site

    @property
    def shares_gpu(self):
        """Whether several cases of a task run on one GPU at the same time."""
        return self.gpus > 0 and self.cases_a_task > 1


@dataclass(frozen=True)
class Speed:
    """Seconds that each count of "work" of `tread check --json` takes on one GPU or CPU core, and the start of a run."""

    start: float
    sand_steps: float
    searches: float
    substeps: float
    joint_substeps: float
    rows: float
    points: float
    yielding_points: float
    pages: float
    bodies: float
    body_substeps: float
    near_substeps: float


# src/run/wall_time.hpp has the same figures; docs/performance.md, "Wall time by model", says where they come from.
GPU_SPEED = Speed(1.0, 9.0e-5, 2.0e-4, 7.0e-5, 8.0e-5, 8.0e-4, 3.3e-10, 1.2e-11, 5.0e-9, 1.0e-8, 3.0e-9, 0.0)
CORE_SPEED = Speed(0.2, 2.0e-5, 3.0e-5, 2.5e-5, 1.0e-4, 1.0e-3, 2.3e-7, 1.1e-7, 5.5e-6, 3.0e-6, 8.0e-7, 2.0e-7)


@dataclass(frozen=True)
class Site:
    """What differs from cluster to cluster."""

    partition: str = ""
    account: str = ""
    qos: str = ""
    constraint: str = ""
    modules: list[str] = field(default_factory=list)
    launcher: str = "mpirun"  # srun: srun --mpi=pmix
    gpus_a_node: int = 0  # 0: whatever is asked for
    program: str = "tread"
    gpu_factor: float = 1.0  # time on a GPU of the site over that on the GPU of the model
    core_factor: float = 1.0  # likewise of a CPU core


def read_resources(table):
    resources = _filled(Resources, table, "[resources]")
    for name in ("nodes", "ranks", "threads", "cases_a_task", "at_once", "signal_lead"):
        if getattr(resources, name) < 1:
            raise CampaignError(f"[resources] {name}: an integer of at least 1")
    if min(resources.gpus, resources.restarts, resources.memory_gb) < 0:
        raise CampaignError("[resources] gpus, restarts and memory_gb are at least 0")
    if resources.backend not in ("auto", "cpu", "cuda"):
        raise CampaignError('[resources] backend: "auto", "cpu" or "cuda"')
    if seconds(resources.wall_time) <= resources.signal_lead:
        raise CampaignError("[resources] wall_time: HH:MM:SS, longer than signal_lead")
    if resources.ranks % resources.nodes or resources.gpus % resources.nodes:
        raise CampaignError("[resources] ranks and gpus are multiples of nodes")
    if resources.cases_a_task > 1 and (resources.ranks > 1 or resources.gpus > 1):
        raise CampaignError("[resources] cases_a_task: cases that share a task have one rank each, and one GPU together")
    if resources.shares_gpu and resources.cases_a_task > MOST_ON_A_GPU:
        raise CampaignError(f"[resources] cases_a_task: at most {MOST_ON_A_GPU} cases can share a GPU")
    return resources


def read_site(name):
    """A file of jobs/sites by its name, or any file by its path; "" is a site without wishes."""
    if not name:
        return Site()
    path = SITES / f"{name}.toml" if re.fullmatch(r"[A-Za-z0-9_-]+", name) else Path(name)
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        known = ", ".join(sorted(file.stem for file in SITES.glob("*.toml")))
        raise CampaignError(f"site {name}: {error}; jobs/sites has {known}") from error
    site = _filled(Site, table, str(path))
    for option in ("partition", "account", "qos", "constraint"):
        if not TOKEN.fullmatch(getattr(site, option)):
            raise CampaignError(f"{path}: {option}: letters, digits and _.:,@%/+=[]&|*- only")
    if site.launcher not in ("mpirun", "srun"):
        raise CampaignError(f'{path}: launcher: "mpirun" or "srun"')
    if not all(isinstance(module, str) and module and "\n" not in module for module in site.modules):
        raise CampaignError(f"{path}: modules is a list of names")
    return site


def seconds(text):
    """Converts HH:MM:SS to seconds; 0 for anything else."""
    found = TIME.fullmatch(text)
    return 3600 * int(found[1]) + 60 * int(found[2]) + int(found[3]) if found else 0


def _filled(kind, table, where):
    """The dataclass with the table's values, each of the type that it has there."""
    types = {item.name: item.type for item in fields(kind)}
    if not isinstance(table, dict):
        raise CampaignError(f"{where}: a table")
    for name, value in table.items():
        if name not in types:
            raise CampaignError(f"{where}: unknown key '{name}'; known are {', '.join(types)}")
        wanted = types[name]
        origin = getattr(wanted, "__origin__", wanted)
        fits = isinstance(value, (int, float) if origin is float else origin) and not isinstance(value, bool)
        if not fits:
            raise CampaignError(f"{where}: {name} is no {origin.__name__}")
    try:
        return kind(**table)
    except TypeError as error:
        raise CampaignError(f"{where}: {error}") from error
