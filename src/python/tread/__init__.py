"""tread from Python: scenes, runs in this process, and what runs leave. docs/python.md."""

from tread.errors import MachineError, NumericalError, SceneError, TreadError
from tread.library import features, soils
from tread.results import CampaignTable, Run, RunError, Study, read_study
from tread.running import run
from tread.scene import Scene
from tread.state import BodyState, JointState, State

__all__ = ["BodyState", "CampaignTable", "JointState", "MachineError", "NumericalError", "Run", "RunError", "Scene", "SceneError", "State",
           "Study", "TreadError", "features", "read_study", "run", "soils"]
