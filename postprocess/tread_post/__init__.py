"""Reads what a tread run leaves behind."""

from tread_post.run import Bodies, Points, Run, RunError, Series, Shape

__all__ = ["Bodies", "Points", "Run", "RunError", "Series", "Shape"]
