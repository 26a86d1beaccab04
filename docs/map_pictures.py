#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Draws docs/map_pictures.png, all layers of the trench's map before and after it was dug.

  docs/map_pictures.py scene > trench_maps.sdf
  navvy run trench_maps.sdf --no-render --out out/maps
  docs/map_pictures.py draw out/maps docs/map_pictures.png [SECONDS]

The scene is the trench with a design and a map of all layers every 5 s. The second picture is the
last map of the run, or the one nearest to SECONDS. Needs NumPy, Pillow and matplotlib (Debian's
python3-matplotlib).
"""
import io
import json
import os
import sys
import zipfile

LAYERS = [
    "elevation",
    "elevation_start",
    "target",
    "cut_fill",
    "slope",
    "step_height",
    "roughness",
    "traversability",
    "loose_depth",
    "density",
    "soil",
    "disturbed_at",
    "active",
]
# Lowest and highest colour (None: of both maps), colours.
RANGES = {
    "elevation": (-0.8, 1.2, "terrain"),
    "elevation_start": (-0.8, 1.2, "terrain"),
    "target": (-0.8, 1.2, "terrain"),
    "cut_fill": (-1.2, 1.2, "RdBu_r"),
    "slope": (0, 1.2, "magma_r"),
    "step_height": (0, 0.4, "magma_r"),
    "roughness": (0, 0.15, "magma_r"),
    "traversability": (0, 1, "RdYlGn"),
    "loose_depth": (0, None, "YlOrBr"),
    "density": (None, None, "cividis"),
    "soil": (-0.5, 1.5, "Pastel2"),
    "disturbed_at": (0, None, "viridis"),
    "active": (0, 1, "YlOrRd"),
}
UNKNOWN = "#dcdcdc"
PART = -10, 7, -9, 8.5  # of the site: least and greatest x, y [m]


def scene():
    here = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scenarios", "trench.sdf")
    with open(here, encoding="utf-8") as file:
        text = file.read()
    more = """    <navvy:design>
      <area>
        <polygon_m>1.65 -0.525 4.85 -0.525 4.85 0.525 1.65 0.525</polygon_m>
        <depth_m>0.8</depth_m>
      </area>
    </navvy:design>
    <navvy:record name="maps">
      <format>npz</format>
      <layers>%s</layers>
      <rate_hz>0.2</rate_hz>
    </navvy:record>
""" % " ".join(
        LAYERS
    )
    before = "    <navvy:recording>"
    if text.count(before) != 1:
        sys.exit("map_pictures.py: trench.sdf has no <navvy:recording> to put the maps before")
    sys.stdout.write(text.replace(before, more + before))


def read(path):
    with zipfile.ZipFile(path) as file:
        return json.loads(file.read("header.json"))


def draw(folder, out, seconds):
    try:
        import matplotlib

        matplotlib.use("Agg")
        from matplotlib import pyplot
        import numpy
        from PIL import Image
    except ImportError:
        sys.exit(
            "map_pictures.py draw needs matplotlib: apt-get install python3-matplotlib, run with"
            " /usr/bin/python3"
        )
    maps = os.path.join(folder, "maps")
    files = sorted(os.path.join(maps, name) for name in os.listdir(maps) if name.endswith(".npz"))
    heads = [read(path) for path in files]
    last = len(files) - 1
    if seconds is not None:
        last = min(range(len(files)), key=lambda i: abs(heads[i]["time_s"] - seconds))
    head = heads[last]
    pair = [numpy.load(files[0]), numpy.load(files[last])]
    x0, y0 = head["origin_m"]
    x1, y1 = x0 + head["nx"] * head["cell_m"], y0 + head["ny"] * head["cell_m"]
    pyplot.rcParams.update({"font.size": 8, "axes.titlesize": 9, "axes.linewidth": 0.5})
    rows = (len(LAYERS) + 1) // 2
    figure = pyplot.figure(figsize=(12, 2.82 * rows))
    grid = figure.add_gridspec(
        rows,
        7,
        width_ratios=[10, 10, 0.45, 3, 10, 10, 0.45],
        left=0.026,
        right=0.948,
        bottom=0.016,
        top=0.982,
        wspace=0.06,
        hspace=0.16,
    )
    for number, layer in enumerate(LAYERS):
        row, column = number // 2, 4 * (number % 2)
        unit = head["layers"][layer]["unit"]
        both = numpy.concatenate([one[layer].ravel() for one in pair])
        low, high, colours = RANGES[layer]
        known = both[numpy.isfinite(both)]
        low = float(known.min()) if low is None else low
        high = max(float(known.max()), low + 0.1) if high is None else high
        table = matplotlib.colormaps[colours].copy()
        if layer == "soil":
            table = matplotlib.colors.ListedColormap(table.colors[:2])
        table.set_bad(UNKNOWN)
        for k, one in enumerate(pair):
            axes = figure.add_subplot(grid[row, column + k])
            shown = axes.imshow(
                numpy.ma.masked_invalid(one[layer]),
                origin="lower",
                extent=(x0, x1, y0, y1),
                cmap=table,
                vmin=low,
                vmax=high,
                interpolation="nearest",
            )
            axes.set_title(
                "%s, %s" % (layer, "before" if k == 0 else "after %.0f s" % head["time_s"]), pad=3
            )
            axes.set_xlim(PART[:2])
            axes.set_ylim(PART[2:])
            axes.set_xticks(range(-10, 6, 5))
            axes.set_yticks(range(-5, 6, 5))
            axes.tick_params(length=2, width=0.5, pad=1.5, labelleft=k == 0, labelsize=7)
        bar = figure.colorbar(shown, cax=figure.add_subplot(grid[row, column + 2]))
        bar.set_label("" if unit == "-" else unit, labelpad=2)
        bar.ax.tick_params(length=2, width=0.5, pad=1.5, labelsize=7)
        if layer in ("soil", "active"):
            bar.set_ticks([0, 1])
    note = figure.add_subplot(grid[rows - 1, 4:7])
    note.axis("off")
    note.text(
        0.04,
        0.92,
        "Grey: unknown. x and y in m, columns of %g m, one colour bar for both.\n\nThe excavator"
        " stands at x = -4 and digs towards itself, between\nx = 1.65 and 4.85; it tips its spoil"
        " at (-1.7, 5.9). At (-6, -6.5)\nlies a heap that was there before. Its tyres have left"
        " ruts.\n\nloose_depth and active: soil that still moves."
        % head["cell_m"],
        va="top",
        fontsize=9,
        linespacing=1.35,
    )
    image = io.BytesIO()
    figure.savefig(image, dpi=100, format="png")
    Image.open(image).convert("RGB").save(out, optimize=True)
    print(
        "%s: %d kB, before and after %.1f s" % (out, os.path.getsize(out) // 1000, head["time_s"])
    )


if __name__ == "__main__":
    if sys.argv[1:] == ["scene"]:
        scene()
    elif len(sys.argv) in (4, 5) and sys.argv[1] == "draw":
        draw(sys.argv[2], sys.argv[3], float(sys.argv[4]) if len(sys.argv) == 5 else None)
    else:
        sys.exit(__doc__)
