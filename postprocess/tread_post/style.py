"""What all figures share: letters, colours, grids and units."""

import io

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from PIL import Image

from tread_post.looks import COLOURS, GREY, GRID, readable, with_unit  # noqa: F401  what all figures share

MARKERS = ("o", "s", "^", "D", "v", "P", "X")
DASHES = ("-", "--", "-.", ":")
LEVELS = 8  # of 255, by which a colour of a picture may be off
PALETTES, LARGEST = (256, 128, 64), 170_000  # colours of a picture that docs/ keeps, the first that fits, and its bytes


def figure_grid(rows, columns, width=13.0, height_each=4.2, **options):
    """Figure and its axes [rows, columns]."""
    plt.rcParams.update({"font.size": 12, "axes.spines.top": False, "axes.spines.right": False})
    return plt.subplots(rows, columns, figsize=(width, height_each * rows), constrained_layout=True, squeeze=False, **options)


def finish(axis):
    axis.grid(color=GRID, linewidth=0.6)
    axis.set_axisbelow(True)


def legend_below(figure, handles, columns):
    """Under all panels, where it hides nothing."""
    figure.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncol=columns, frameon=False)


def png_of(figure, dpi):
    """Bytes of a picture. Closes the figure."""
    drawn = io.BytesIO()
    figure.savefig(drawn, format="png", dpi=dpi, bbox_inches="tight", pad_inches=0.15)
    plt.close(figure)
    return packed_png(drawn.getvalue())


def packed_png(data):
    """A PNG in about half of the bytes, never more: no colour is off by more than LEVELS, which no eye sees."""
    image = Image.open(io.BytesIO(data)).convert("RGB")
    few = image.quantize(256, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    off = np.abs(np.asarray(few.convert("RGB")).astype(int) - np.asarray(image))
    if off.max() > LEVELS:
        few = image.point([min(255, (level + LEVELS // 2) // LEVELS * LEVELS) for level in range(256)] * 3)
    packed = io.BytesIO()
    few.save(packed, format="png", optimize=True)
    return min(packed.getvalue(), data, key=len)


def write(figure, path):
    path.write_bytes(png_of(figure, 110))
    print(path)


def write_shaded(figure, path):
    """Writes a figure whose smooth shades `write` would band, small as docs/ keeps it."""
    figure.savefig(path, dpi=110, bbox_inches="tight", pad_inches=0.15)
    plt.close(figure)
    pack_picture(path)
    print(path)


def pack_picture(path):
    """Rewrites a PNG with fewer colours, and smaller where it is still over LARGEST."""
    image, scale, palettes = Image.open(path).convert("RGB"), 1.0, list(PALETTES)
    while True:
        size = (round(scale * image.width), round(scale * image.height))
        few = image.resize(size, Image.Resampling.LANCZOS).quantize(palettes[0], method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
        data = io.BytesIO()
        few.save(data, format="png", optimize=True)
        if len(data.getvalue()) <= LARGEST or scale < 0.5:
            break
        if len(palettes) > 1:
            palettes.pop(0)
        else:
            scale *= 0.93
    if len(data.getvalue()) < 0.97 * path.stat().st_size:
        path.write_bytes(data.getvalue())
