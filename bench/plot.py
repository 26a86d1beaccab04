#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Draws bench rows as roofline.svg and scaling.svg: plot.py ROWS.csv [MORE.csv ...] --out FOLDER.

The roofline plot shows operations per second over operations per byte; each device's roof is its
measured copy bandwidth and its measured peak of fused multiply-adds. The scaling plot shows
particle-steps per second over the number of active particles and, beside it, time over the site's
area. Needs Debian's python3-matplotlib.
"""
import argparse
import csv
import os
import sys

try:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot
except ImportError:
    sys.exit(
        "plot.py needs matplotlib: apt-get install python3-matplotlib, and run it with"
        " /usr/bin/python3"
    )


def read(paths):
    rows = []
    for path in paths:
        try:
            with open(path, newline="", encoding="utf-8") as file:
                rows += list(csv.DictReader(file))
        except OSError as error:
            sys.exit("plot.py: %s" % error)
    return rows


def fastest(rows):
    """One row for each bench and device: the run that was disturbed least."""
    best = {}
    for row in rows:
        key = (row.get("bench"), row.get("device"))
        if key not in best or value(row, "particle_steps_per_s") > value(
            best[key], "particle_steps_per_s"
        ):
            best[key] = row
    return list(best.values())


def value(row, column):
    try:
        return float(row.get(column) or 0)
    except ValueError:
        return 0.0


def by_device(rows):
    out = {}
    for row in rows:
        out.setdefault(row.get("device", ""), []).append(row)
    return out


def roofline(rows, path):
    figure, axes = pyplot.subplots(figsize=(7, 4.5))
    reach = [2.0**k for k in range(-2, 9)]
    for index, (device, own) in enumerate(sorted(by_device(rows).items())):
        color = "C%d" % index
        copy, peak = (
            max(value(r, column) for r in own) for column in ("copy_bytes_per_s", "fma_flops_per_s")
        )
        if copy <= 0 or peak <= 0:
            continue
        roof = sorted(reach + [peak / copy])
        axes.plot(
            roof,
            [min(peak, copy * x) / 1e9 for x in roof],
            color=color,
            label="%s: roof" % device[:40],
        )
        points = [
            r
            for r in own
            if value(r, "bytes_per_particle_step") > 0 and value(r, "flops_per_particle_step") > 0
        ]
        # Rows share one count of operations and bytes, so only the lowest and the highest are
        # labelled.
        points.sort(key=lambda r: value(r, "particle_steps_per_s"))
        for k, row in enumerate(points):
            x = value(row, "flops_per_particle_step") / value(row, "bytes_per_particle_step")
            y = value(row, "flops_per_particle_step") * value(row, "particle_steps_per_s") / 1e9
            axes.plot(x, y, "o", color=color, markersize=4)
            if k in (0, len(points) - 1):
                axes.annotate(
                    row["bench"], (x, y), textcoords="offset points", xytext=(6, -3), fontsize=7
                )
    axes.set_xscale("log", base=2)
    axes.set_yscale("log")
    axes.set_xlabel("operations per byte of traffic")
    axes.set_ylabel("10$^9$ operations per second")
    axes.set_title("Soil steps under the measured roof")
    axes.grid(True, which="major", alpha=0.3)
    axes.legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(path)


def scaling(rows, path):
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(9, 4))
    for index, (device, own) in enumerate(sorted(by_device(rows).items())):
        color, label = "C%d" % index, device[:40]
        for prefix, mark in (("soil_collapse_no_tool", "o-"), ("soil_dig", "s--")):
            line = sorted(
                (value(r, "particles"), value(r, "particle_steps_per_s") / 1e6)
                for r in own
                if r["bench"].split(":")[0] == prefix and value(r, "particles") > 0
            )
            if line:
                left.plot(
                    *zip(*line), mark, color=color, markersize=4, label="%s, %s" % (prefix, label)
                )
        line = sorted(
            (value(r, "site_m") ** 2 / 1e6, value(r, "min_ms") / max(value(r, "steps"), 1))
            for r in own
            if value(r, "site_m") > 0
        )
        if line:
            right.plot(*zip(*line), "o-", color=color, markersize=4, label=label)
    left.set_xscale("log")
    left.set_xlabel("active particles")
    left.set_ylabel("10$^6$ particle-steps per second")
    right.set_xscale("log")
    right.set_xlabel("site [km$^2$] at 0.1 m")
    right.set_ylabel("ms a step of the same dig")
    for axes in (left, right):
        axes.set_ylim(0, 1.15 * axes.get_ylim()[1])
        axes.grid(True, which="major", alpha=0.3)
        if axes.get_legend_handles_labels()[0]:
            axes.legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(path)


def main():
    parser = argparse.ArgumentParser(description="Draws bench rows: roofline.svg and scaling.svg.")
    parser.add_argument("rows", nargs="+", help="CSV files of `navvy bench --csv`")
    parser.add_argument("--out", default=".", help="folder for the pictures")
    options = parser.parse_args()
    rows = fastest(read(options.rows))
    matplotlib.rcParams["svg.hashsalt"] = "navvy"  # the same rows give the same file
    os.makedirs(options.out, exist_ok=True)
    for draw, name in ((roofline, "roofline.svg"), (scaling, "scaling.svg")):
        path = os.path.join(options.out, name)
        draw(rows, path)
        print(path)


if __name__ == "__main__":
    main()
