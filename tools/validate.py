# SPDX-License-Identifier: Apache-2.0
"""`./dev validate`: the slow cases, and the tables of docs/validation.md."""
import concurrent.futures
import datetime
import hashlib
import re
import sys
import threading
import time

import build
import packages
import testing
import workspace
from workspace import BUILD, JOBS, ROOT, DevError, clock, say

DEVIATIONS = "tests/tolerances/known_deviations.md"
RESULTS = "tests/validation/results.csv"
SECONDS = "tests/validation/seconds.csv"
FOLDER = BUILD / "validate"
# What decides the result of a case, less the files that only describe it.
SOURCES = [
    "src",
    "kernels",
    "tests",
    "scenarios",
    "vehicles",
    "terrain",
    "cmake",
    "CMakeLists.txt",
    "CMakePresets.json",
]
NO_SOURCES = {"README.md", "seconds.csv", "results.csv", "table.py"}
# A case of at most so many seconds runs with --quick; one whose duration is unknown is taken for as
# long.
QUICK = 60


def slow_cases():
    """Returns the names of the slow tests; CTest lists a case with parameters as "NAME  #
    GetParam() = ...".
    """
    listed = workspace.output("ctest", "--test-dir", BUILD, "-N", "-L", "slow")
    return re.findall(r"^ *Test *#\d+: (\S+)", listed, re.MULTILINE)


def read_seconds(path):
    """Returns {case: seconds} of a file with a row NAME,SECONDS for each case; empty without the
    file.
    """
    if not (ROOT / path).is_file():
        return {}
    rows = [line.split(",") for line in (ROOT / path).read_text(encoding="utf-8").splitlines()]
    return {row[0]: int(row[1]) for row in rows if len(row) > 1 and row[1].isdigit()}


def case_log(name):
    """Returns the path of the output of a case's last run."""
    return FOLDER / (name.replace("/", "-") + ".log")


def sources_stamp():
    """Returns a hash of everything that decides the results: a case that passed with it need not
    run again.
    """
    paths = [
        path
        for name in SOURCES
        for path in (sorted((ROOT / name).rglob("*")) if (ROOT / name).is_dir() else [ROOT / name])
    ]
    digest = hashlib.sha256()
    for path in paths:
        if path.is_file() and path.name not in NO_SOURCES and "__pycache__" not in path.parts:
            digest.update(
                ("%s\0" % path.relative_to(ROOT)).encode()
                + hashlib.sha256(path.read_bytes()).digest()
            )
    return digest.hexdigest()[:16]


def tables(*arguments):
    """Runs the script of the validation tables."""
    workspace.run(sys.executable, "-B", "tests/validation/table.py", *arguments)


def keep_values(log):
    """Puts the values of a log into results.csv and writes the tables of docs/validation.md anew.

    `log` is NAME=LOG of one case, or CTest's log of many.
    """
    seconds = (
        ["--seconds", FOLDER / "seconds.csv"] if (ROOT / FOLDER / "seconds.csv").is_file() else []
    )
    tables(
        "collect",
        RESULTS,
        log,
        *seconds,
        "--date",
        datetime.date.today().isoformat(),
        "--device",
        build.device_name(),
        "--state",
        build.state_name()
    )
    tables("write", RESULTS, "docs/validation.md")
    tables("summary", RESULTS, "docs/validation_summary.md")


def check_known_deviations(names):
    """Raises DevError when the table has a row for a case that does not exist: it would excuse
    nothing.
    """
    rows = [
        line.split("|")
        for line in (ROOT / DEVIATIONS).read_text(encoding="utf-8").splitlines()
        if line.startswith("|")
    ]
    for row in rows[2:]:
        if row[1].strip() not in names:
            raise DevError(
                "%s has a row for '%s', which is no slow case" % (DEVIATIONS, row[1].strip())
            )


def known_deviations(names):
    """Returns the deviations that the table excuses, as the cases' last runs printed them."""
    logs = [ROOT / case_log(name) for name in names]
    texts = [log.read_text(encoding="utf-8", errors="replace") for log in logs if log.is_file()]
    return [
        line
        for text in texts
        for line in re.findall(r"^\d*: \[KNOWN DEVIATION\] (.*)$", text, re.MULTILINE)
    ]


class Validation:
    """One run of some cases side by side. A case that passes is remembered until the sources
    change.
    """

    def __init__(self, done_file):
        self.done_file = ROOT / done_file
        self.done = (
            set(self.done_file.read_text(encoding="utf-8").split())
            if self.done_file.is_file()
            else set()
        )
        self.seconds = {**read_seconds(SECONDS), **read_seconds(FOLDER / "seconds.csv")}
        self.results = {}  # name: "passed", "FAILED" or "skipped"
        self.lock = threading.Lock()
        self.begun = time.monotonic()
        self.due = []

    def planned(self, name):
        """Returns the seconds that a case is expected to take."""
        return self.seconds.get(name, QUICK)

    def run(self, names):
        """Runs the cases, the longest first, so that none is waited for alone."""
        self.due = sorted(names, key=self.planned, reverse=True)
        say(
            "validate: %d cases to run, %d at a time, at most about %s"
            % (len(self.due), JOBS, clock(sum(map(self.planned, self.due))))
        )
        pool = concurrent.futures.ThreadPoolExecutor(JOBS)
        try:
            for result in [pool.submit(self.run_case, name) for name in self.due]:
                result.result()
        finally:
            pool.shutdown(cancel_futures=True)

    def run_case(self, name):
        """Runs one case on JOBS' share of the cores; keeps its output, its values and, when it
        passed, its seconds.
        """
        log, begun = case_log(name), time.monotonic()
        report = log.with_suffix(".xml")
        (ROOT / report).unlink(missing_ok=True)
        # Results are the same for any number of threads, and small rigs keep only one busy.
        env = {"POCL_MAX_PTHREAD_COUNT": "1"} if JOBS > 1 else {}
        status = workspace.run_logged(
            log,
            "ctest",
            "--test-dir",
            BUILD,
            "-L",
            "slow",
            "-R",
            "^%s( |$)" % name.replace(".", "\\."),
            "--verbose",
            "--no-tests=error",
            "--output-junit",
            ROOT / report,
            env=env,
        )
        result = (
            "FAILED" if status != 0 else "passed" if testing.ran_something(report) else "skipped"
        )
        with self.lock:
            self.keep(name, result, time.monotonic() - begun)

    def keep(self, name, result, seconds):
        """Records and prints the result of a case."""
        before = self.planned(name)
        self.results[name] = (result, before)
        if result == "passed":
            self.done.add(name)
            self.done_file.write_text("\n".join(sorted(self.done)) + "\n", encoding="utf-8")
            here = {**read_seconds(FOLDER / "seconds.csv"), name: int(seconds)}
            (ROOT / FOLDER / "seconds.csv").write_text(
                "".join("%s,%d\n" % row for row in sorted(here.items())), encoding="utf-8"
            )
        log = case_log(name)
        if result != "skipped":
            try:
                keep_values("%s=%s" % (name, log))
            except DevError:
                say("the values of %s were not kept" % name)
        if result == "FAILED":
            workspace.print_tail(log)
        text = (ROOT / log).read_text(encoding="utf-8", errors="replace")
        print(
            "".join(line + "\n" for line in re.findall(r"^\d*: (\|.* \|)$", text, re.MULTILINE)),
            end="",
        )
        say(self.progress("%s: %s in %s" % (name, result, clock(seconds))))

    def progress(self, what):
        """Returns a line with how many cases have ended, how long that took, and what is left at
        this pace.
        """
        spent = time.monotonic() - self.begun
        ended = sum(planned for _, planned in self.results.values())
        left = sum(map(self.planned, self.due)) - ended
        return "validate %d/%d %s; elapsed %s, left about %s" % (
            len(self.results),
            len(self.due),
            what,
            clock(spent),
            clock(max(0, left * spent / ended if ended else left)),
        )

    def of(self, result):
        """Returns the cases with this result."""
        return [name for name, (found, _) in self.results.items() if found == result]


def validate_command(arguments):
    """Runs the slow cases, as many at a time as there are cores, and prints the time left.

    Goes on where it stopped, until the sources change. Ends with the known deviations
    (tests/tolerances/known_deviations.md), keeps the measured values in
    tests/validation/results.csv and writes the tables of docs/validation.md.
    """
    parser = workspace.parser(validate_command, "validate [--quick] [CASE]")
    parser.add_argument(
        "--quick",
        action="store_true",
        help="only cases of at most a minute: under half an hour in all on two cores",
    )
    parser.add_argument(
        "case",
        nargs="?",
        default="",
        help="only cases whose name holds this, also if they passed before",
    )
    options = parser.parse_args(arguments)
    packages.install(packages.BASE)
    build.build()
    names = slow_cases()
    check_known_deviations(names)
    cases = [name for name in names if options.case in name]
    if not cases:
        raise DevError("no slow case matches '%s'; there is: %s" % (options.case, " ".join(names)))
    (ROOT / FOLDER).mkdir(parents=True, exist_ok=True)
    validation = Validation(FOLDER / ("passed-" + sources_stamp()))
    due = [name for name in cases if options.case or name not in validation.done]
    if options.quick:
        due = [name for name in due if validation.planned(name) <= QUICK]
    validation.run(due)
    report(validation, cases)


def report(validation, cases):
    """Prints the summary of a validation. Raises DevError when a case failed or every one was
    skipped.
    """
    say("all measured values: docs/validation.md, from " + RESULTS)
    known = known_deviations(cases)
    if known:
        say(
            "known deviations, each with its row in %s:\n%s"
            % (DEVIATIONS, "\n".join("  " + line for line in known))
        )
    passed, skipped, failed = (validation.of(result) for result in ("passed", "skipped", "FAILED"))
    if skipped:
        say("skipped, their data or device is not here: " + " ".join(skipped))
    say(
        "validate: %d passed, %d skipped, %d failed, %d known deviations, %d not run "
        "(passed before, or left out by --quick), %s"
        % (
            len(passed),
            len(skipped),
            len(failed),
            len(known),
            len(cases) - len(validation.results),
            clock(time.monotonic() - validation.begun),
        )
    )
    if failed:
        raise DevError("failed: " + " ".join(failed))
    if len(skipped) == len(cases):
        raise DevError("every case was skipped")
