# SPDX-License-Identifier: Apache-2.0
"""Checks a folder of another simulator's worlds, and counts those that Navvy reads without errors.

    python3 tools/import_worlds.py FOLDER --navvy build/release/src/cli/navvy

Worlds that name models on a server are counted apart: Navvy downloads nothing. Options after `--`
go to `navvy check`; by default they are `--soil loam --size 40,40`.
"""
import argparse
import pathlib
import re
import subprocess
import sys

COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
ON_SERVER = re.compile(r"<uri>\s*https?://")


def check(navvy, world, options):
    """Returns whether `navvy check` accepts the file, and its errors."""
    try:
        done = subprocess.run(
            [navvy, "check", str(world), *options],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            timeout=300,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return False, ["error: the check took more than 300 s"]
    errors = [line for line in done.stdout.splitlines() if "error:" in line]
    if done.returncode != 0 and not errors:
        errors = [f"error: exit status {done.returncode}"]
    return done.returncode == 0, errors


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--navvy", default="navvy", help="the program")
    parser.add_argument("--least", type=int, default=0, help="fail with fewer clean worlds")
    parser.add_argument("options", nargs="*", default=None, help="options of navvy check")
    arguments = parser.parse_args()
    options = arguments.options or ["--soil", "loam", "--size", "40,40"]
    clean = local = server = 0
    for world in sorted(arguments.folder.glob("*.sdf")):
        text = COMMENT.sub("", world.read_text(encoding="utf-8", errors="replace"))
        if ON_SERVER.search(text):
            server += 1
            continue
        local += 1
        good, errors = check(arguments.navvy, world, options)
        clean += good
        if not good:
            print(f"{world.name}: {len(errors)} errors, first: {errors[0][:300]}")
    print(f"{clean} of {local} worlds check clean; {server} more name models on a server")
    return 0 if clean >= arguments.least else 1


if __name__ == "__main__":
    sys.exit(main())
