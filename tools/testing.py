# SPDX-License-Identifier: Apache-2.0
"""`./dev test`: the tests of CTest, and what their report says."""
import shutil
import xml.etree.ElementTree

import build
import packages
import workspace
from workspace import BUILD, JOBS, ROOT, DevError


def ran_something(report):
    """Returns whether a JUnit report of CTest has a test that ran; CTest counts skipped tests as
    passed.
    """
    path = ROOT / report
    if not path.is_file():
        return False
    cases = xml.etree.ElementTree.parse(path).getroot().iter("testcase")
    return any(case.get("status") in ("run", "fail") for case in cases)


def ctest(*arguments, preset=workspace.PRESET, report=None, check=True):
    """Runs tests of a built preset, as many at a time as JOBS; returns CTest's status."""
    options = []
    if report is not None:
        (ROOT / report).unlink(missing_ok=True)
        options = ["--output-junit", ROOT / report]
    return workspace.run(
        "ctest",
        "--test-dir",
        "build/" + preset,
        "-j",
        JOBS,
        "--output-on-failure",
        "--no-tests=error",
        *options,
        *arguments,
        check=check
    )


def test_command(arguments):
    """Builds, then runs every test but the slow and the nightly ones.

    Arguments go on to ctest, such as -R NAME. Fails when every test was skipped, as where no OpenCL
    device is. A whole run keeps its log for `./dev docs`.
    """
    if arguments[:1] in (["--help"], ["-h"]):
        workspace.parser(test_command, "test [ctest options]", add_help=False).print_help()
        return
    packages.install(packages.BASE)
    build.build()
    build.link_program()
    report = BUILD / "test-report.xml"
    ctest("-LE", "slow|nightly", *arguments, report=report)
    if not arguments:
        shutil.copyfile(
            ROOT / BUILD / "Testing" / "Temporary" / "LastTest.log", ROOT / BUILD / "test.log"
        )
    if not ran_something(report):
        raise DevError(
            "no test ran: every one was skipped (is there an OpenCL device? see './navvy devices')"
        )
