"""Campaigns: one file of axes becomes cases, jobs, and one table. The standard library only, but for collect."""
