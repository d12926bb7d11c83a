"""One HTML page that needs nothing else: figures and styles stand in it."""

import base64
import html

STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; max-width: 1280px; margin: 2em auto; padding: 0 1em; color: #222; background: #fff; }
h1 { font-size: 1.7em; } h2 { font-size: 1.25em; margin-top: 2em; border-bottom: 1px solid #ccc; }
table { border-collapse: collapse; font-size: 0.85em; } .wide { overflow-x: auto; }
th, td { padding: 0.25em 0.55em; border-bottom: 1px solid #e2e2e2; text-align: right; white-space: nowrap; }
th { background: #f3f3f3; position: sticky; top: 0; } td.text, th.text { text-align: left; }
tr.not-done td, tr.failed td { background: #fdf0e2; } tr.under-resolved td { background: #fbe3e0; } tr.marginal td { background: #fff8dc; }
p.headline { font-weight: bold; font-size: 1.15em; } pre { background: #f6f6f6; padding: 0.8em; overflow-x: auto; font-size: 0.8em; }
img { max-width: 100%; } figcaption { color: #555; font-size: 0.9em; }
"""


def page(title, parts, head=f"<style>{STYLE}</style>"):
    """The text of the page; `parts` are pieces of HTML, `head` what stands beside its title."""
    begin = f"<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{escape(title)}</title>\n{head}\n</head>\n"
    return begin + f"<body>\n<h1>{escape(title)}</h1>\n" + "\n".join(parts) + "\n</body>\n</html>\n"


class Markup(str):
    """A piece of HTML, which a table takes as it is."""


def escape(text):
    return html.escape(str(text))


def section(title, *parts):
    return f"<h2>{escape(title)}</h2>\n" + "\n".join(parts)


def paragraph(text):
    return f"<p>{escape(text)}</p>"


def headline_paragraph(text):
    return f"<p class=\"headline\">{escape(text)}</p>"


def preformatted(text):
    return f"<pre>{escape(text)}</pre>"


def figure(picture, caption):
    """A matplotlib figure, inlined."""
    from tread_post.style import png_of

    source = base64.b64encode(png_of(picture, 100)).decode()
    return f"<figure><img alt=\"{escape(caption)}\" src=\"data:image/png;base64,{source}\"><figcaption>{escape(caption)}</figcaption></figure>"


def table(head, rows, kinds=()):
    """Cells are texts or Markup, to the left, or numbers. `kinds`: class of each row, by which it stands out; empty of those that do not."""
    def cell(tag, value):
        is_text = isinstance(value, str)
        shown = value if is_text else "" if value != value else f"{value:.4g}"
        return f"<{tag}{' class=text' if is_text else ''}>{shown if isinstance(shown, Markup) else escape(shown)}</{tag}>"

    lines = ["<tr>" + "".join(cell("th", name) for name in head) + "</tr>"]
    for number, row in enumerate(rows):
        kind = f' class="{escape(kinds[number])}"' if kinds and kinds[number] else ""
        lines.append(f"<tr{kind}>" + "".join(cell("td", value) for value in row) + "</tr>")
    return "<div class=\"wide\"><table>\n" + "\n".join(lines) + "\n</table></div>"
