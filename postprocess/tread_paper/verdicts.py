"""How well each stored run of docs/paper/runs was resolved, by its own summary."""

import json

from tread_post.run import RunError
from tread_post.verdict import headline, resolution_of, text_of


def lines_of(folder):
    """Lines of Markdown: a headline, and a row a run."""
    found = {}
    for path in sorted(folder.glob("*/summary.json")):
        try:
            found[path.parent.name] = resolution_of(json.loads(path.read_text(encoding="utf-8")))
        except ValueError as error:
            raise RunError(f"{path}: {error}") from error
    lines = [f"**{headline([one.verdict for one in found.values()], 'stored runs')}**", "", "| run | verdict | worst figure |", "|---|---|---|"]
    return lines + [f"| {name} | {text_of(one.verdict)} | {one.worst_figure} |" for name, one in found.items()]
