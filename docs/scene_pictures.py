#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws contact sheets of pictures of scenes.

    python3 docs/scene_pictures.py build/release/src/cli/navvy   # docs/scenes.jpg
    python3 docs/scene_pictures.py BEFORE AFTER                  # docs/looks.jpg
    python3 docs/scene_pictures.py --jobs build/release/src/cli/navvy RUN...  # docs/jobs.jpg

The first shows each shipped scene at its start, as its first camera sees it. The second shows the
PNG files that two folders have in common side by side, the third the last picture of each run
(`--pictures png`) beside the map of what it has cut and filled. Needs python3-pil.
"""
import pathlib
import subprocess
import sys
import tempfile

from PIL import Image, ImageDraw

ROOT = pathlib.Path(__file__).resolve().parent.parent
COLUMNS, WIDTH, HEIGHT, GAP, TITLE = 4, 400, 225, 6, 16


def read(file):
    """Returns the picture of a file, WIDTH x HEIGHT pixels."""
    with Image.open(file) as image:
        return image.convert("RGB").resize((WIDTH, HEIGHT), Image.LANCZOS)


def write_sheet(name, pictures):
    """Writes docs/NAME, a sheet of pairs (title, picture)."""
    rows = -(-len(pictures) // COLUMNS)
    size = (COLUMNS * (WIDTH + GAP) + GAP, rows * (HEIGHT + TITLE + GAP) + GAP)
    sheet = Image.new("RGB", size, "white")
    draw = ImageDraw.Draw(sheet)
    for number, (title, picture) in enumerate(pictures):
        row, column = divmod(number, COLUMNS)
        x, y = GAP + column * (WIDTH + GAP), GAP + row * (HEIGHT + TITLE + GAP)
        sheet.paste(picture, (x, y + TITLE))
        draw.text((x, y + 2), title, fill="black")
    sheet.save(ROOT / "docs" / name, quality=80, optimize=True)


def scenes(program):
    """Returns the pictures of all shipped scenes at their start."""
    folder = ROOT / "scenarios"
    out = []
    with tempfile.TemporaryDirectory() as scratch:
        file = pathlib.Path(scratch) / "picture.png"
        for scene in sorted(folder.rglob("*.sdf")):
            subprocess.run(
                [program, "show", scene, "--out", file], check=True, stdout=subprocess.DEVNULL
            )
            out.append((scene.relative_to(folder).with_suffix("").as_posix(), read(file)))
    return out


def pairs(before, after):
    """Returns the pictures that two folders have in common, in turn."""
    out = []
    for file in sorted(pathlib.Path(before).glob("*.png")):
        other = pathlib.Path(after) / file.name
        if other.exists():
            out += [(f"{file.stem}, before", read(file)), (f"{file.stem}, after", read(other))]
    return out


def jobs(program, runs):
    """Returns the last picture and the map of changes of each run, in turn."""
    out = []
    with tempfile.TemporaryDirectory() as scratch:
        file = pathlib.Path(scratch) / "map.png"
        for run in map(pathlib.Path, runs):
            subprocess.run(
                [program, "map", run, "--layers", "change", "--format", "relief", "--out", file],
                check=True,
                stdout=subprocess.DEVNULL,
            )
            last = sorted((run / "frames").glob("*.png"))[-1]
            out += [(run.name, read(last)), (f"{run.name}: cut and fill", read(file))]
    return out


def main():
    if sys.argv[1:2] == ["--jobs"] and len(sys.argv) > 3:
        write_sheet("jobs.jpg", jobs(sys.argv[2], sys.argv[3:]))
        return
    if len(sys.argv) == 2:
        write_sheet("scenes.jpg", scenes(sys.argv[1]))
    elif len(sys.argv) == 3:
        write_sheet("looks.jpg", pairs(*sys.argv[1:]))
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
