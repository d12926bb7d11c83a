"""Means of the campaigns configs/campaigns/sensitivity*.toml as a table: what a conclusion of section 3.4 hangs on."""

import numpy as np

from tread_post.campaign import CampaignTable

QUANTITIES = (("torque", 1.0, "torque [N m]"), ("drawbar_pull", 1.0, "F_x [N]"), ("sinkage", 1e3, "sinkage [mm]"))


def lines_of(folders):
    """Makes a row for each value of the first axis of collected campaigns: mean over the repeats, and half of what they differ by."""
    lines = ["| | " + " | ".join(title for _, _, title in QUANTITIES) + " | cases |", "|---|" + "---|" * (len(QUANTITIES) + 1)]
    for folder in folders:
        table = CampaignTable(folder)
        axis = table.axes[0]
        labels = table[f"labels/{axis.name}"]
        for label in dict.fromkeys(labels):
            rows = labels == label
            cells = [_cell(factor * table[name][rows]) for name, factor, _ in QUANTITIES]
            known = np.isfinite(table["torque"][rows]).sum()
            lines.append(f"| {folder.name}: {axis.name} {label} | " + " | ".join(cells) + f" | {known} |")
    return lines


def _cell(values):
    known = values[np.isfinite(values)]
    if not len(known):
        return "-"
    return f"{known.mean():.1f}" if len(known) == 1 else f"{known.mean():.1f} ± {0.5 * np.ptp(known):.1f}"
