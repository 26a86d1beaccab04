# SPDX-License-Identifier: Apache-2.0
"""`./dev fault`, `./dev soak`: long tests that go on where they stopped; `./dev readers`."""
import hashlib
import pathlib
import shutil
import sys

import build
import packages
import workspace
from workspace import BUILD, JOBS, ROOT, say


def stamped_folder(name, program):
    """Returns the folder of a campaign, emptied when the program has changed: earlier results are
    of another one then.
    """
    stamp = hashlib.sha256((ROOT / program).read_bytes()).hexdigest()[:16]
    folder = ROOT / BUILD / name
    if not (folder / stamp).is_file():
        shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / stamp).touch()
    return folder


def fault_command(arguments):
    """Attacks a small run: calls that fail, kills; N attacks or all, some 3000.

    NAVVY_JOBS attacks run at a time. Goes on where it stopped, until the program changes
    (tests/README.md).
    """
    parser = workspace.parser(fault_command, "fault [N]")
    parser.add_argument(
        "number", nargs="?", type=int, default=0, metavar="N", help="number of attacks; 0: all"
    )
    number = parser.parse_args(arguments).number
    packages.install(packages.BASE)
    build.build("navvy", "navvy_fault_campaign")
    folder = stamped_folder("fault", workspace.NAVVY)
    workspace.run(BUILD / "tests" / "fault" / "navvy_fault_campaign", folder, number, JOBS)


# The driver's compiler puts a signal stack in the place of the sanitizer's. Freed memory would wait
# in a quarantine of 256 MiB, and resident memory would grow until that is full.
SOAK_UNDER_SANITIZERS = {
    "ASAN_OPTIONS": "detect_leaks=1:use_sigaltstack=0:"
    "quarantine_size_mb=4:thread_local_quarantine_size_kb=64"
}


def soak_command(arguments):
    """Simulates hours of scoops in one process, 1 by default.

    Bytes in use must stay flat, no mass may be lost, and the state must be that of four resumed
    quarters. With --sanitize the program is clang's build under the sanitizers of addresses, leaks
    and undefined behaviour. Goes on where it stopped, until the program changes (tests/README.md).
    """
    parser = workspace.parser(soak_command, "soak [HOURS] [--sanitize]")
    parser.add_argument("hours", nargs="?", default="1", help="simulated hours")
    parser.add_argument("--sanitize", action="store_true", help="under the address sanitizer")
    parsed = parser.parse_args(arguments)
    if parsed.sanitize:
        packages.install(packages.BASE, packages.CLANG)
        build.build("navvy_soak", preset="fuzz", quiet=True)
    else:
        packages.install(packages.BASE)
        build.build("navvy_soak")
    at = pathlib.Path("build/fuzz") if parsed.sanitize else BUILD
    program = at / "tests" / "soak" / "navvy_soak"
    folder = stamped_folder("soak_sanitized" if parsed.sanitize else "soak", program)
    env = SOAK_UNDER_SANITIZERS if parsed.sanitize else None
    status = workspace.run(program, folder, parsed.hours, env=env, check=False)
    say("soak: %s/phases.csv, bytes.svg" % folder.relative_to(ROOT))
    if status != 0:
        raise workspace.DevError(status=status)


def readers_command(arguments):
    """Installs readers of our files from PyPI into build/readers: mcap, rosbags, urdf_parser_py.

    With imageio-ffmpeg comes a program ffmpeg. Tests that read bags, descriptions of machines and
    videos are skipped without them.
    """
    workspace.parser(readers_command, "readers").parse_args(arguments)
    packages.install(packages.READERS)
    workspace.run(sys.executable, "-m", "venv", "build/readers")
    wanted = ["mcap==1.6.0", "rosbags==0.11.9", "urdf_parser_py==0.0.4", "imageio-ffmpeg==0.8.1"]
    workspace.run("build/readers/bin/pip", "-q", "install", *wanted)
