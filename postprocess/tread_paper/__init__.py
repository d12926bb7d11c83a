"""The paper's cases: what its numbers and figures are compared with, from runs of configs/paper."""
