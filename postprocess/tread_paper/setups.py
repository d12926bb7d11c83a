"""The states that pictures of the paper's set-ups show, Figs. 7 a, 9, 12, 15 and 20: the program makes them anew, of Fig. 7 a a whole run, else the first
state of a scene."""

import shlex
import subprocess
import tempfile
import tomllib
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from tread_post import Run, RunError

# A run that ends with its first step: what is drawn is the snapshot before it.
FIRST_STATE = ('phase=[{name="start",duration=1e-9}]', "output.snapshots_every=1")
FALL = (*FIRST_STATE, "body.wheel.gap=0.52")  # the paper's of section 3.3
EVERY = "output.snapshots_every=0.0125"  # s; at 62.5 ms the spheres are closest, and at 100 ms the run ends


@dataclass(frozen=True)
class State:
    """A run of configs/paper/SCENE.toml with settings."""

    scene: str
    set: tuple = FIRST_STATE

    def path(self, scenes):
        return scenes / f"{self.scene}.toml"

    def command(self, program, scenes, folder):
        settings = [word for setting in self.set for word in ("--set", setting)]
        return [str(program), "run", str(self.path(scenes)), *settings, "--output", str(folder), "--quiet"]


@dataclass(frozen=True)
class Setup:
    """A picture: its caption, the states that it needs, and the name of the function of setup_figures.py that draws it."""

    caption: str
    states: tuple
    draw: str


@dataclass(frozen=True)
class Made:
    """The run of a state, and the scene whose phases it left out."""

    run: Run
    scene: dict


@contextmanager
def made(setup, program, scenes):
    """A Made for each state of a picture. The runs are gone afterwards. RunError where one fails."""
    with tempfile.TemporaryDirectory() as folder:
        runs = []
        for number, state in enumerate(setup.states):
            place = Path(folder) / str(number)
            command = state.command(program, scenes, place)
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            if done.returncode:
                raise RunError(f"{shlex.join(command)}: {(done.stderr or done.stdout).strip()}")
            runs.append(Made(Run(place), tomllib.loads(state.path(scenes).read_text(encoding="utf-8"))))
        yield runs


def figure_of(setup, program, scenes):
    """Draws a picture as a figure. Needs VTK and a display."""
    from tread_paper import setup_figures

    with made(setup, program, scenes) as runs:
        return getattr(setup_figures, setup.draw)(runs)


SETUPS = {
    "head_on": {"head_on_setup": Setup(
        "A rigid sphere meets one of material points: before, at the closest, and after (Fig. 7 a)", (State("head_on_1", (EVERY,)),), "collision")},
    "wheel_drop": {"wheel_drop_setup": Setup(
        "The three beds before gravity acts, and the rock (Fig. 9)",
        (State("wheel_drop_rock"), State("wheel_drop_sand"), State("wheel_drop_mixed")), "drops")},
    "rolling": {"rolling_setup": Setup(
        "Four terrains before gravity acts, the wheel where the paper's fall begins (Fig. 12)",
        (State("rolling_spheres", FALL), State("rolling_rocks", FALL), State("rolling_sand", FALL), State("rolling_mixed", FALL)), "rolls")},
    "slip": {"slip_setup": Setup(
        "Sand, and sand with rocks, before gravity acts, and how the wheel is driven (Fig. 15)", (State("slip_sand"), State("slip_mixed")), "slips")},
    "spirit": {"spirit_setup": Setup(
        "A crust of rocks on soft sand before gravity acts, and how the wheel is driven (Fig. 20)", (State("spirit"),), "crust")},
}
