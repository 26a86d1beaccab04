#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws docs/scenes.jpg: each shipped scene at its start, as its first camera sees it.

    python3 docs/scene_pictures.py build/release/src/cli/navvy

Needs python3-pil.
"""
import pathlib
import subprocess
import sys
import tempfile

from PIL import Image, ImageDraw

ROOT = pathlib.Path(__file__).resolve().parent.parent
COLUMNS, WIDTH, HEIGHT, GAP, TITLE = 4, 400, 225, 6, 16


def picture_of(program, scene, folder):
    """Returns the picture of a scene at its start, WIDTH x HEIGHT pixels."""
    file = pathlib.Path(folder) / "picture.png"
    subprocess.run([program, "show", scene, "--out", file], check=True, stdout=subprocess.DEVNULL)
    with Image.open(file) as image:
        return image.convert("RGB").resize((WIDTH, HEIGHT), Image.LANCZOS)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = ROOT / "scenarios"
    scenes = sorted(folder.rglob("*.sdf"))
    rows = -(-len(scenes) // COLUMNS)
    size = (COLUMNS * (WIDTH + GAP) + GAP, rows * (HEIGHT + TITLE + GAP) + GAP)
    sheet = Image.new("RGB", size, "white")
    draw = ImageDraw.Draw(sheet)
    with tempfile.TemporaryDirectory() as scratch:
        for number, scene in enumerate(scenes):
            row, column = divmod(number, COLUMNS)
            x, y = GAP + column * (WIDTH + GAP), GAP + row * (HEIGHT + TITLE + GAP)
            sheet.paste(picture_of(sys.argv[1], scene, scratch), (x, y + TITLE))
            name = scene.relative_to(folder).with_suffix("").as_posix()
            draw.text((x, y + 2), name, fill="black")
    sheet.save(ROOT / "docs" / "scenes.jpg", quality=80, optimize=True)


if __name__ == "__main__":
    main()
