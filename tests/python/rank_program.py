"""A program of several ranks for test_ranks.py: WHAT OUTPUT. Steers as rank 0 asks, or fails on rank 1."""

import os
import sys

import tread
from package import BALL, SCENE

what, output = sys.argv[1:]
comm = None
if what == "mpi4py":
    from mpi4py import MPI

    comm = MPI.COMM_WORLD.Split(0, -MPI.COMM_WORLD.rank)  # ranks in another order

points = []


def visit(state):
    if state.points.id is not None:
        points.append(len(state.points.id))
    if what == "steer" and not state.over:
        rank = 0 if comm is None else comm.rank
        state.steer("ball", spin=3.0 + rank)
    if what == "fail" and state.steps > 5 and os.environ["OMPI_COMM_WORLD_RANK"] == "1":
        raise LookupError("on one rank")


run = tread.run(tread.Scene.from_text(BALL if what == "steer" else SCENE), output, backend="cpu", threads=1, on_span=visit, span_steps=5)
print(f"points {points[-1] if points else 0} status {run.summary['status']}", flush=True)
