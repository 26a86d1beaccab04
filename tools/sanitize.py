# SPDX-License-Identifier: Apache-2.0
"""`./dev sanitize`: what sanitizers see of host tests, of two real worlds and of the kernels."""
import os
import subprocess
import tempfile

import build
import packages
import testing
import workspace
from workspace import BUILD, PRESET, ROOT, DevError, say

PRESETS = {"address": "fuzz", "thread": "thread"}
# The simulator's compiler knows no prefetch and no scopes of aliasing, which inlining makes of
# restrict: so neither, and nothing inlined. --uninitialized is of no use: it takes what the
# built-in any() returns for uninitialised.
OCLGRIND = [
    "oclgrind",
    "--data-races",
    "--num-threads",
    "1",
    "--max-errors",
    "20",
    "--build-options",
    "-cl-opt-disable -Drestrict= -D__builtin_prefetch(x)=",
]


def two_worlds(preset):
    """Runs two real worlds in threads; returns their names, steps and state hashes.

    They have a cache of their own, so that kernels are compiled under the sanitizer, too. The
    driver loses memory of its own in that, and its compiler puts an alternate signal stack in the
    place of the sanitizer's, which would free it.
    """
    with tempfile.TemporaryDirectory() as folder:
        env = {
            "ASAN_OPTIONS": "detect_leaks=0:use_sigaltstack=0",
            "POCL_CACHE_DIR": folder,
            "NAVVY_DEVICE": "cpu",
            **thread_options(preset),
        }
        done = subprocess.run(
            [
                ROOT / "build" / preset / "tests" / "sanitize" / "navvy_worlds",
                "scenarios/bucket_path.sdf",
                "2",
                "scenarios/trench.sdf",
                "2",
            ],
            cwd=ROOT,
            env={**os.environ, **env},
            stdout=subprocess.PIPE,
            text=True,
            check=False,
        )
    if done.returncode != 0:
        raise DevError(done.stdout + "the sanitizer found something, or a world failed")
    return done.stdout


def thread_options(preset):
    """Returns the environment of ThreadSanitizer, with the findings in other libraries that are
    left out.
    """
    if preset != "thread":
        return {}
    return {
        "TSAN_OPTIONS": "second_deadlock_stack=1 suppressions=%s/tests/sanitize/thread.supp" % ROOT
    }


def sanitize_runs(preset):
    """Runs host tests and two worlds in clang's build under the sanitizers of a preset.

    The same worlds in GCC's build must end in the same states: two compilers, two degrees of
    optimisation.
    """
    build.build("navvy_host_tests", "navvy_worlds", preset=preset, quiet=True)
    os.environ.update(thread_options(preset))
    testing.ctest("-L", "host", "-LE", "slow|nightly", preset=preset)
    clang = two_worlds(preset)
    build.build("navvy_worlds")
    gcc = two_worlds(PRESET)
    print(clang, end="")
    if clang != gcc:
        raise DevError("the build in %s ends in other states:\n%s" % (BUILD, gcc))
    say("two worlds: no finding, and the states of the build in %s" % BUILD)


def under_oclgrind(log, *arguments, env=None, check=True):
    """Runs the kernels' program under Oclgrind, which writes wrong accesses and races to `log`."""
    (ROOT / log).unlink(missing_ok=True)
    return workspace.run(
        *OCLGRIND,
        "--log",
        log,
        BUILD / "tests" / "sanitize" / "navvy_kernels",
        *arguments,
        env=env,
        check=check
    )


def sanitize_kernels():
    """Runs every soil kernel in both schedules under Oclgrind, which checks each access and looks
    for races.
    """
    packages.install(packages.OCLGRIND)
    build.build("navvy_kernels")
    log = BUILD / "oclgrind.log"
    under_oclgrind(log, "broken")
    if "Invalid read of size 4" not in (ROOT / log).read_text(encoding="utf-8"):
        raise DevError(
            "Oclgrind does not report a read behind a buffer: its silence proves nothing"
        )
    for schedule in ("lanes", "groups"):
        say("all kernels of schedule %s under Oclgrind: minutes" % schedule)
        if under_oclgrind(log, env={"NAVVY_SOIL_SCHEDULE": schedule}, check=False) != 0:
            raise DevError("the run under Oclgrind failed")
        findings = (ROOT / log).read_text(encoding="utf-8") if (ROOT / log).is_file() else ""
        if findings:
            raise DevError("Oclgrind found something in schedule %s:\n%s" % (schedule, findings))
        say("schedule %s: no wrong access, no race" % schedule)


def sanitize_command(arguments):
    """Runs what sanitizers can see of the program; by default all three.

    address   all host tests, then bucket_path for 2 s beside trench for 2 s, each in a thread of
              its own; checks undefined behaviour, too
    thread    the same under ThreadSanitizer
    kernels   every soil kernel in both schedules under Oclgrind
    """
    parser = workspace.parser(sanitize_command, "sanitize [address] [thread] [kernels]")
    parser.add_argument("what", nargs="*", metavar="WHAT", help="address, thread or kernels")
    whats = parser.parse_args(arguments).what or ["address", "thread", "kernels"]
    unknown = [what for what in whats if what != "kernels" and what not in PRESETS]
    if unknown:
        raise DevError(
            "nothing to sanitize by the name '%s'; there is: address thread kernels" % unknown[0]
        )
    packages.install(packages.BASE, packages.CLANG)
    for what in whats:
        if what == "kernels":
            sanitize_kernels()
        else:
            sanitize_runs(PRESETS[what])
