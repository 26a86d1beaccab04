# SPDX-License-Identifier: Apache-2.0
"""Debian packages that Navvy needs, and their installation."""
import os
import shutil
import subprocess

import workspace
from workspace import DevError, say

# What a Debian 12 machine needs to build, run and test Navvy.
BASE = " ".join(
    (
        # tools
        "g++ cmake ninja-build ccache pkg-config git",
        # OpenCL: loader, headers, the CPU device
        "ocl-icd-opencl-dev opencl-headers pocl-opencl-icd",
        # simulation and its files
        "libeigen3-dev libbullet-dev libsdformat-dev libtinyxml2-dev libgdal-dev",
        # pictures; maps in PNG files
        "libcoin-dev libosmesa6-dev libpng-dev",
        # meshes
        "libtinyobjloader-dev libassimp-dev",
        # the program
        "libcli11-dev libspdlog-dev nlohmann-json3-dev",
        # bags for ROS 2
        "libfastcdr-dev libsqlite3-dev",
        # NPZ archives; data of pages
        "libzip-dev zlib1g-dev",
        # pages of runs
        "libjs-three libjs-dygraphs",
        # live pages of runs
        "libcpp-httplib-dev",
        # paths of go_to
        "libompl-dev",
        # tests, tables of docs/validation.md
        "libgtest-dev gdal-bin python3 python3-pil",
    )
).split()
# What each of these commands needs on top.
FORMAT = ["clang-format"]
CLANG = ["clang-format", "clang-tidy", "clang", "libclang-rt-14-dev"]
BENCH = ["libbenchmark-dev"]
DOCS = [
    "python3-sphinx",
    "python3-myst-parser",
    "python3-breathe",
    "python3-sphinx-rtd-theme",
    "doxygen",
]
OCLGRIND = ["oclgrind"]
# Not YADE, which brings 140 packages.
PEERS = ["lammps"]
# libclc of the release of LLVM that clang is of.
GPU_CHECK = ["clang", "libclc-14", "libclc-14-dev"]
READERS = ["python3-venv"]
PYTHON = ["python3-venv", "python3-dev"]

# False after --no-install.
enabled = True


def missing(names):
    """Returns those packages that are not installed."""
    return [
        name
        for name in names
        if workspace.output("dpkg-query", "-W", "-f", "${db:Status-Status}", name, check=False)
        != "installed"
    ]


def apt_get(log, *arguments):
    """Runs apt-get as root, appends its output to the list `log`; returns whether it worked."""
    root = [] if os.geteuid() == 0 else ["sudo"]
    command = root + [
        "env",
        "DEBIAN_FRONTEND=noninteractive",
        "apt-get",
        "-qq",
        "-y",
        "-o",
        "Dpkg::Use-Pty=0",
        "-o",
        "DPkg::Lock::Timeout=120",
        *arguments,
    ]
    done = subprocess.run(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    log.append(done.stdout)
    return done.returncode == 0


def install(*groups):
    """Installs the missing packages of `groups` (lists of names); prints which, if any.

    Raises DevError when apt-get fails, with its output.
    """
    if not enabled:
        return
    if shutil.which("dpkg-query") is None:
        say("not a Debian machine: packages are up to you (lists in tools/packages.py)")
        return
    names = missing(dict.fromkeys(name for group in groups for name in group))
    if not names:
        return
    if os.geteuid() != 0 and shutil.which("sudo") is None:
        raise DevError(
            "these packages are missing and there is no sudo; as root: apt-get install "
            "--no-install-recommends " + " ".join(names)
        )
    say("installing missing Debian packages (minutes when it is many): " + " ".join(names))
    log = []
    # The lists are fetched when a package is not in them, or when they proved stale.
    known = (
        subprocess.run(
            ["apt-cache", "show", "--no-all-versions", *names],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            check=False,
        ).returncode
        == 0
    )
    if not known and not apt_get(log, "update"):
        raise DevError("apt-get update failed:\n" + "".join(log))
    if not apt_get(log, "install", "--no-install-recommends", *names):
        apt_get(log, "update")
        if not apt_get(log, "install", "--no-install-recommends", *names):
            raise DevError("apt-get install failed:\n" + "".join(log))


def install_command(arguments):
    """Only installs missing Debian packages.

    Every other command installs what it needs by itself unless --no-install is given.
    """
    parser = workspace.parser(install_command, "install [--dev]")
    parser.add_argument(
        "--dev", action="store_true", help="also what format, lint, fuzz and sanitize need"
    )
    install(BASE, CLANG if parser.parse_args(arguments).dev else [])
