# SPDX-License-Identifier: Apache-2.0
"""`./dev fault`, `./dev soak`: long tests that go on where they stopped; `./dev readers`."""
import hashlib
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


def soak_command(arguments):
    """Simulates hours of scoops in one process, 1 by default.

    Bytes in use must stay flat, no mass may be lost, and the state must be that of four resumed
    quarters. Goes on where it stopped, until the program changes (tests/README.md).
    """
    parser = workspace.parser(soak_command, "soak [HOURS]")
    parser.add_argument("hours", nargs="?", default="1", help="simulated hours")
    hours = parser.parse_args(arguments).hours
    packages.install(packages.BASE)
    build.build("navvy_soak")
    program = BUILD / "tests" / "soak" / "navvy_soak"
    folder = stamped_folder("soak", program)
    status = workspace.run(program, folder, hours, check=False)
    say("soak: %s/phases.csv, bytes.svg" % folder.relative_to(ROOT))
    if status != 0:
        raise workspace.DevError(status=status)


def readers_command(arguments):
    """Installs the Python packages mcap and rosbags from PyPI into build/readers.

    Tests that read bags are skipped without them.
    """
    workspace.parser(readers_command, "readers").parse_args(arguments)
    packages.install(packages.READERS)
    workspace.run(sys.executable, "-m", "venv", "build/readers")
    workspace.run("build/readers/bin/pip", "-q", "install", "mcap==1.6.0", "rosbags==0.11.9")
