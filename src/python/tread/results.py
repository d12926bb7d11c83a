"""What runs, campaigns and studies leave, by the readers of postprocess."""

from tread_post.campaign import CampaignTable
from tread_post.run import Run, RunError
from tread_post.study_table import Study, read_study

__all__ = ["CampaignTable", "Run", "RunError", "Study", "read_study"]
