# SPDX-License-Identifier: Apache-2.0
"""`./dev nightly`: what CI leaves out."""
import sys
import time

import build
import campaigns
import fuzz
import jobs
import lint
import sanitize
import testing
import validate
import wheel
import workspace
from workspace import DevError, say


def nightly_tests():
    """Runs the tests that CI leaves out, such as each header compiled by itself."""
    build.build()
    testing.ctest("-L", "nightly", "-LE", "slow")


# Name and call of each step; a step that fails does not keep the others from running.
STEPS = [
    ("lint of all sources", lambda: lint.lint_command(["--all"])),
    ("core preset as a bare GPU machine builds it", build.build_bare_core),
    ("tests with label nightly", nightly_tests),
    (
        "host tests and two worlds under sanitizers, kernels under Oclgrind",
        lambda: sanitize.sanitize_command([]),
    ),
    (
        "20 simulated minutes of scoops under sanitizers, with leaks",
        lambda: campaigns.soak_command(["0.334", "--sanitize"]),
    ),
    ("the wheel: built, repaired, installed in an empty environment, digs", wheel.wheel_command),
    (
        "the documentation's site",
        lambda: workspace.run(sys.executable, "-B", "tools/docs.py"),
    ),
    ("every fuzz target for a minute", lambda: fuzz.fuzz_command(["60"])),
    ("jobs of record", lambda: jobs.jobs_command([])),
    ("slow cases", lambda: validate.validate_command([])),
]


def nightly_command(arguments):
    """Runs what CI leaves out, hours on two cores; ends with a table of results.

    Lint of all sources, the core preset without cache and precompiled headers, tests with label
    nightly (each header by itself), `sanitize`, 20 simulated minutes of `soak` under the address
    sanitizer, the Python wheel, the documentation's site, a minute of every fuzz target, `jobs`,
    `validate`. A step that fails does not keep the others from running; the command fails in the
    end. The table shows as skipped what needs the network where there is none.
    """
    workspace.parser(nightly_command, "nightly").parse_args(arguments)
    rows = []
    for name, step in STEPS:
        say("nightly: " + name)
        begun, result = time.monotonic(), "passed"
        try:
            if step() == "skipped":
                result = "skipped"
        except DevError as error:
            result = "FAILED"
            if str(error):
                say(str(error))
        rows.append("%-7s %6d s  %s" % (result, time.monotonic() - begun, name))
    print("\n".join(rows))
    if any(row.startswith("FAILED") for row in rows):
        raise DevError("nightly failed")
