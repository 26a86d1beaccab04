# SPDX-License-Identifier: Apache-2.0
"""CMake presets: configures and builds them."""
import os
import shutil
import subprocess

import packages
import workspace
from workspace import BUILD, JOBS, NAVVY, PRESET, ROOT, DevError, say


def configure(preset, *options):
    """Configures build/<preset> once (again when `options` are given); CMake notices changes of its
    files by itself.
    """
    folder = ROOT / "build" / preset
    if not options and any((folder / name).is_file() for name in ("build.ninja", "Makefile")):
        return
    say("configuring build/%s" % preset)
    done = subprocess.run(
        ["cmake", "--preset", preset, *options],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    if done.returncode != 0:
        raise DevError("configuring build/%s failed:\n%s" % (preset, done.stdout))
    print_warnings(done.stdout)


def print_warnings(text):
    """Prints the lines of CMake's output that hold a warning, with five lines after each."""
    lines = text.splitlines()
    shown = {i + k for i, line in enumerate(lines) if "CMake Warning" in line for k in range(6)}
    for i in sorted(shown & set(range(len(lines)))):
        print(lines[i])


def build(*targets, preset=PRESET, quiet=False):
    """Builds targets of a preset, everything without targets."""
    configure(preset)
    command = ["cmake", "--build", "build/" + preset, "-j", JOBS]
    if targets:
        command += ["--target", *targets]
    workspace.run(*command, *(["--", "--quiet"] if quiet else []))


def link_program():
    """Links the built navvy to ./navvy, where people look for it."""
    if not (ROOT / NAVVY).is_file():
        return
    link = ROOT / "navvy"
    if link.is_symlink():
        link.unlink()
    if not link.exists():
        link.symlink_to(NAVVY)


def build_command(arguments):
    """Configures and builds everything, or only the given targets; links the program to ./navvy.

    Builds into build/release, with CI=true into build/ci with warnings as errors.
    """
    parser = workspace.parser(build_command, "build [TARGET...]")
    parser.add_argument("target", nargs="*", help="targets of CMake, such as navvy or test_soil")
    targets = parser.parse_args(arguments).target
    packages.install(packages.BASE)
    build(*targets)
    link_program()


def build_bare_core():
    """Builds the core preset as a bare GPU machine does: make, no cache, no precompiled headers,
    all warnings.
    """
    shutil.rmtree(ROOT / "build" / "core", ignore_errors=True)
    workspace.run(
        "cmake", "--preset", "core", "-DNAVVY_WARNINGS_AS_ERRORS=ON", stdout=subprocess.DEVNULL
    )
    workspace.run("cmake", "--build", "build/core", "-j", JOBS)


def build_precompiled(preset):
    """Builds the precompiled headers of a preset of clang's, which clang-tidy reads."""
    configure(preset)
    listed = workspace.output("ninja", "-C", "build/" + preset, "-t", "targets", "all")
    headers = [
        line.partition(":")[0]
        for line in listed.splitlines()
        if line.partition(":")[0].endswith(".pch")
    ]
    workspace.run("ninja", "-C", "build/" + preset, *headers, stdout=subprocess.DEVNULL)


def state_name():
    """Returns the commit, with "-dirty" when anything but measured values has changed since."""
    changed = workspace.output(
        "git",
        "status",
        "--porcelain",
        "--",
        ".",
        ":!tests/validation/results.csv",
        ":!docs/validation.md",
        ":!docs/validation_summary.md",
        check=False,
    )
    name = workspace.output("git", "describe", "--always", check=False).strip() or "unknown"
    return name + ("-dirty" if changed.strip() else "")


def device_name():
    """Returns the OpenCL device that runs take, as `navvy devices` lists it."""
    wanted = os.environ.get("NAVVY_DEVICE", "")
    lines = workspace.output(NAVVY, "devices", check=False).splitlines()
    named = [line for line in lines if wanted in line] if wanted else lines
    return named[0].partition(": ")[2] or named[0] if named else ""
