"""What `tread check` says of cases: whether they are right, and what they will cost."""

import json
import os
import re
import subprocess
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, fields

from tread_jobs.errors import CampaignError, MachineError
from tread_jobs.resources import CORE_SPEED, GPU_SPEED, Speed


@dataclass(frozen=True)
class Plan:
    points: int
    bodies: int
    simulated: float  # s, at most
    steps: float
    disk: float  # bytes, at most
    memory: float  # bytes on the backend
    scene: str  # hash of the resolved scene: equal for equal runs
    set_up: float  # s, in which `check` built the world
    work: dict[str, float]  # expected counts, named as in Speed


@dataclass(frozen=True)
class Cost:
    """Cost of a whole campaign; steps and disk at most, time as expected by the model."""

    cases: int
    checked: int
    steps: float
    gpu_hours: float
    core_hours: float
    disk: float  # bytes
    longest: float  # s, the case that takes longest

    @property
    def text(self):
        machine = f"{self.gpu_hours:.3g} GPU-hours" if self.gpu_hours else f"{self.core_hours:.3g} core-hours"
        basis = "" if self.checked == self.cases else f" (from {self.checked} of them, evenly spread)"
        return (f"{self.cases} cases{basis}: at most {self.steps:.3g} steps, {machine} by the model, "
                f"the longest case {self.longest:.3g} s, disk {self.disk / 1e9:.3g} GB")

    @property
    def table(self):
        return asdict(self)


def check_cases(program, cases, most, scratch):
    """Plans of `most` cases, evenly spread over all. CampaignError with tread's own words for the first that is wrong."""
    count = min(most, len(cases))
    picked = [cases[round(index * (len(cases) - 1) / max(1, count - 1))] for index in range(count)]

    def check(case):
        scene = scratch / f"{case.name}.toml"
        scene.write_text(case.scene_text, encoding="utf-8")
        try:
            done = subprocess.run([program, "check", "--json", str(scene)], capture_output=True, text=True, check=False)
        except OSError as error:
            raise MachineError(f"{program}: {error.strerror}; --tread names the program") from error
        if done.returncode:
            values = ", ".join(f"{name} {label}" for name, label in case.labels.items())
            # The file that was checked is gone when this is read.
            words = re.sub(rf"{re.escape(str(scene))}(:\d+)?: ", "", done.stderr.strip() or done.stdout.strip())
            raise CampaignError(f"case {case.name} ({values}): {words}")
        return plan_of(done.stdout, program)

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(check, picked))


def cost_of(plans, count, resources, site):
    """Scaled from the cases that were checked to all `count` of them."""
    scale = count / len(plans)
    units = resources.gpus if resources.gpus else resources.ranks * resources.threads
    times = [seconds_of(plan, resources, site) for plan in plans]
    hours = scale * sum(times) * units / 3600
    # Cases that share a GPU take at most as long as one after the other.
    longest = max(times) * (resources.cases_a_task if resources.gpus else 1)
    return Cost(count, len(plans), scale * sum(plan.steps for plan in plans), hours if resources.gpus else 0.0,
                0.0 if resources.gpus else hours, scale * sum(plan.disk for plan in plans), longest)


NOT_SHARED = ("sand_steps", "searches", "substeps", "joint_substeps", "rows")  # between cores or GPUs


def seconds_of(plan, resources, site):
    """Expected wall time of a case by the model of src/run/wall_time.hpp."""
    speed, factor = (GPU_SPEED, site.gpu_factor) if resources.gpus else (CORE_SPEED, site.core_factor)
    units = resources.gpus if resources.gpus else resources.ranks * resources.threads
    costs = {count: getattr(speed, count) * number for count, number in plan.work.items()}
    serial = sum(costs.pop(count) for count in NOT_SHARED)
    return plan.set_up + factor * (speed.start + serial + sum(costs.values()) / units)


def plan_of(text, program):
    try:
        said = json.loads(text)
        work = {item.name: said["work"][item.name] for item in fields(Speed) if item.name != "start"}
        return Plan(said["points"], said["bodies"], said["time"], said["steps"], said["disk"], said["memory"], said["scene"], said["set_up"], work)
    except (ValueError, KeyError, TypeError) as error:
        raise MachineError(f"{program}: check says nothing of points, steps, memory and disk; is it tread?") from error
