# SPDX-License-Identifier: Apache-2.0
"""`./dev run`: builds, then runs a scene."""
import pathlib
import re
import time

import build
import packages
import workspace
from workspace import ROOT, clock, say

DEFAULT_SCENE = "scenarios/trench.sdf"


def option_value(arguments, name):
    """Returns the value of an option given as "NAME VALUE" or "NAME=VALUE"; the last one counts,
    empty without one.
    """
    value = ""
    for word, following in zip(arguments, arguments[1:] + [""]):
        if word == name:
            value = following
        elif word.startswith(name + "="):
            value = word[len(name) + 1 :]
    return value


def results_folder(scene, arguments):
    """Returns the folder that `navvy run` writes to: --out, or out/<name of the scene>; empty when
    it is unknown.
    """
    out = option_value(arguments, "--out")
    if out:
        return out
    # A shipped scene may be named without its path.
    path = ROOT / scene
    if not path.is_file():
        path = ROOT / "scenarios" / (pathlib.Path(scene).name.removesuffix(".sdf") + ".sdf")
    if not path.is_file():
        return ""
    name = re.search(r'<world[^>]* name="([^"]*)"', path.read_text(encoding="utf-8"))
    return "out/" + name[1] if name else ""


def run_command(arguments):
    """Builds, links the program to ./navvy, then runs a scene (default scenarios/trench.sdf).

    Options go on to `navvy run`; `./navvy run --help` lists them. Prints the time of the
    compilation apart from that of the run, and where the results are. NAVVY_DEVICE picks the OpenCL
    device (cpu, gpu, an index, a part of a name).
    """
    parser = workspace.parser(run_command, "run [FILE.sdf] [options of navvy run]", add_help=False)
    if arguments[:1] in (["--help"], ["-h"]):
        parser.print_help()
        return
    scene, options = DEFAULT_SCENE, list(arguments)
    if options and not options[0].startswith("-"):
        scene = options.pop(0)
    packages.install(packages.BASE)
    begun = time.monotonic()
    build.build("navvy")
    build.link_program()
    say(
        "compiled in %s; the program is ./navvy (`./navvy --help` lists its commands)"
        % clock(time.monotonic() - begun)
    )
    begun = time.monotonic()
    status = workspace.run("./navvy", "run", scene, *options, check=False)
    say("the run took %s" % clock(time.monotonic() - begun))
    report_results(scene, results_folder(scene, options))
    if status != 0:
        raise workspace.DevError(status=status if status > 0 else 128 - status)


def report_results(scene, folder):
    """Prints what the run has left in its folder."""
    if not folder or not (ROOT / folder).is_dir():
        return
    say(
        "results are in %s: %s"
        % (folder, " ".join(sorted(entry.name for entry in (ROOT / folder).iterdir())))
    )
    pictures = len(list((ROOT / folder / "frames").glob("*.png")))
    for film in sorted((ROOT / folder / "frames").glob("*.mp4")):
        say("video: %s/frames/%s" % (folder, film.name))
    if pictures:
        say(
            "%d pictures in %s/frames; more of them: ./navvy run %s --set camera.rate_hz=2"
            % (pictures, folder, scene)
        )
