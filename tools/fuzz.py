# SPDX-License-Identifier: Apache-2.0
"""`./dev fuzz`: libFuzzer targets, their kept inputs and totals."""
import base64
import concurrent.futures
import datetime
import gzip
import re
import shutil
import threading
import time

import build
import packages
import workspace
from workspace import CI, JOBS, ROOT, DevError, say

# Found inputs, logs and crashes of both builds go to build/fuzz.
SANITIZED, FAST = "fuzz", "fuzz-fast"
FOUND = "build/fuzz/corpus"
KEPT = "build/fuzz/kept"
TOTALS = "tests/fuzz/totals.csv"
BROKEN_SCENES = "build/fuzz/broken_scenes"
# Time that one pass over the kept inputs may take [s]; others may keep the machine busy, so only
# five times that fails.
REPLAY_AIM = 60
# Inputs that a target aims at over all runs; other targets at a million.
AIMS = {"loader": 100000, "snapshot": 100000, "mesh": 100000, "urdf": 100000}
# Folders that a target starts from besides its own inputs.
SEEDS = {"world": [BROKEN_SCENES], "loader": [BROKEN_SCENES, "scenarios"]}


def target_names():
    """Returns the names of all targets."""
    return sorted(
        path.name.removesuffix("_fuzz.cpp") for path in (ROOT / "tests" / "fuzz").glob("*_fuzz.cpp")
    )


def count(folder):
    """Returns the number of files in a folder."""
    return sum(1 for path in (ROOT / folder).rglob("*") if path.is_file())


def added_total(text, name, inputs, sanitized, seconds, crashes, today):
    """Returns the text of totals.csv with one run of a target added to its row."""
    rows, found = [line.split(",") for line in text.splitlines()], False
    for row in rows:
        if row[0] == name:
            found = True
            for column, more in zip(range(2, 6), (inputs, sanitized, seconds, crashes)):
                row[column] = str(int(row[column]) + more)
            row[6] = today
    if not found:
        aim = str(AIMS.get(name, 1000000))
        rows.append([name, aim, str(inputs), str(sanitized), str(seconds), str(crashes), today])
    return "".join(",".join(row) + "\n" for row in rows)


class Limit:
    """End of a walk: a number of seconds, or one of inputs."""

    def __init__(self, seconds, inputs=None):
        self.seconds = seconds
        self.inputs = inputs

    def option(self):
        """Returns the option of libFuzzer."""
        if self.inputs is not None:
            return "-runs=%d" % self.inputs
        return "-max_total_time=%d" % self.seconds

    def text(self):
        """Returns the limit in words."""
        return "%d s" % self.seconds if self.inputs is None else "%d inputs" % self.inputs


def taken_limit(words):
    """Removes the limit of a walk from the words of the command line and returns it. Raises
    DevError for --inputs without a number.
    """
    if "--inputs" in words:
        at = words.index("--inputs")
        if len(words) < at + 2 or not words[at + 1].isdigit() or int(words[at + 1]) == 0:
            raise DevError("--inputs needs a number of inputs, such as 100000")
        inputs = int(words[at + 1])
        del words[at : at + 2]
        return Limit(None, inputs)
    return Limit(int(words.pop()) if words and words[-1].isdigit() else 60)


class Fuzzers:
    """Targets of one build, with sanitizers or without."""

    def __init__(self, preset, names):
        self.preset = preset
        self.names = names
        self.lock = threading.Lock()  # of totals.csv
        build.build("fuzz_inputs", *[name + "_fuzz" for name in names], preset=preset, quiet=True)

    def inputs(self, *arguments):
        """Runs the program that packs and unpacks inputs."""
        workspace.run("build/%s/tests/fuzz/fuzz_inputs" % self.preset, *arguments)

    def unpack(self, name):
        """Writes a target's kept inputs as files and returns their folder."""
        folder = "%s/%s" % (KEPT, name)
        self.inputs("unpack", "tests/fuzz/corpus/%s.pack" % name, folder)
        return folder

    def pack(self, name):
        """Writes the files of a target's kept inputs back as its pack."""
        self.inputs("pack", "%s/%s" % (KEPT, name), "tests/fuzz/corpus/%s.pack" % name)

    def fuzz(self, name, *arguments):
        """Runs libFuzzer on one target; returns whether it found nothing.

        The output goes to build/fuzz/NAME.log. Each input may take 20 s and 2 GB.
        """
        (ROOT / "build/fuzz/crashes").mkdir(parents=True, exist_ok=True)
        # Entropic schedules take a third of the time of inputs as quick as these, and the stack of
        # every allocation a fifth: a crash shows all of them when its input is given to the target
        # by itself.
        asan = "malloc_context_size=1:quarantine_size_mb=64"
        # The OpenCL driver loses memory of its own when it compiles.
        if name in ("snapshot", "control"):
            asan += ":detect_leaks=0"
        # One thread of the driver: several targets run side by side.
        env = {"POCL_MAX_PTHREAD_COUNT": "1", "ASAN_OPTIONS": asan, "NAVVY_DEVICE": "cpu"}
        return (
            workspace.run_logged(
                "build/fuzz/%s.log" % name,
                "build/%s/tests/fuzz/%s_fuzz" % (self.preset, name),
                "-timeout=20",
                "-rss_limit_mb=2048",
                "-entropic=0",
                "-print_final_stats=1",
                "-artifact_prefix=build/fuzz/crashes/%s-" % name,
                *arguments,
                env=env
            )
            == 0
        )

    def require(self, name, failure, *arguments):
        """Runs a target. Raises DevError with the end of its log when it finds something."""
        if not self.fuzz(name, *arguments):
            workspace.print_tail("build/fuzz/%s.log" % name)
            raise DevError("%s %s" % (name, failure))

    def replay(self):
        """Gives each target its kept inputs: what once crashed or hung must not do so again."""
        begun = time.monotonic()
        for name in self.names:
            folder = self.unpack(name)
            self.require(name, "fails on its corpus", "-runs=0", folder)
            say("%s: %d inputs replayed" % (name, count(folder)))
        took = time.monotonic() - begun
        say("corpus replayed in %d s, of %d s aimed at" % (took, REPLAY_AIM))
        if took > 5 * REPLAY_AIM:
            raise DevError(
                "the replay took more than five times %d s: drop inputs from tests/fuzz/corpus, "
                "or make targets faster" % REPLAY_AIM
            )

    def check_found(self):
        """Gives each target what the walks found, which were perhaps made without sanitizers."""
        for name in self.names:
            folder = "%s/%s" % (FOUND, name)
            if (ROOT / folder).is_dir():
                self.require(
                    name, "fails under the sanitizers on what was found", "-runs=0", folder
                )
                say("%s: %d found inputs hold under the sanitizers" % (name, count(folder)))

    def shrink(self):
        """Adds to each pack the fewest found inputs that reach every line reached so far."""
        for name in self.names:
            folder = self.unpack(name)
            (ROOT / FOUND / name).mkdir(parents=True, exist_ok=True)
            self.require(
                name,
                "cannot be shrunk",
                "-set_cover_merge=1",
                "-use_counters=0",
                folder,
                "%s/%s" % (FOUND, name),
            )
            self.pack(name)
            say("%s: %d inputs kept" % (name, count(folder)))

    def keep(self, name, files):
        """Adds files to a target's pack."""
        folder = self.unpack(name)
        for file in files:
            shutil.copy(file, ROOT / folder)
        self.pack(name)

    def walk(self, limit):
        """Fuzzes each target to a Limit, JOBS at a time, from what was found before. Raises
        DevError on a crash.
        """
        self.inputs("scenes", "tests/scene_io/broken_scenes.txt", BROKEN_SCENES)
        with concurrent.futures.ThreadPoolExecutor(JOBS) as pool:
            good = list(pool.map(lambda name: self.walk_target(name, limit), self.names))
        failed = [name for name, passed in zip(self.names, good) if not passed]
        if failed:
            raise DevError(
                "fuzz targets failed: %s (inputs in build/fuzz/crashes)" % " ".join(failed)
            )

    def walk_target(self, name, limit):
        """Fuzzes one target; returns whether nothing was found."""
        (ROOT / FOUND / name).mkdir(parents=True, exist_ok=True)
        seeds = [self.unpack(name)] + SEEDS.get(name, [])
        say("fuzzing %s for %s" % (name, limit.text()))
        # CI repeats one walk, so that a change is judged by what it changes; by hand every call
        # walks elsewhere.
        seed = ["-seed=1"] if CI else []
        begun = time.monotonic()
        good = self.fuzz(name, limit.option(), *seed, "%s/%s" % (FOUND, name), *seeds)
        seconds = round(time.monotonic() - begun)
        log = (ROOT / "build/fuzz" / (name + ".log")).read_text(encoding="utf-8", errors="replace")
        found = re.search(r"^stat::number_of_executed_units: *(\d+)", log, re.MULTILINE)
        inputs = int(found[1]) if found else 0
        totals = self.add_total(name, inputs, seconds, 0 if good else 1)
        if good:
            row = re.search(r"^%s,(\d+),(\d+)" % name, totals, re.MULTILINE)
            say(
                "%s: %d inputs, %d/s%s"
                % (
                    name,
                    inputs,
                    inputs / max(1, seconds),
                    "; over all runs %s of %s" % (row[2], row[1]) if row else "",
                )
            )
        else:
            workspace.print_tail("build/fuzz/%s.log" % name)
            self.print_crash(name, begun)
        return good

    def print_crash(self, name, begun):
        """Prints the newest input that a walk found since `begun` [s, of the monotonic clock], so
        that it can be tried where the log is all there is.
        """
        age = time.monotonic() - begun
        new = [
            path
            for path in (ROOT / "build/fuzz/crashes").glob(name + "-*")
            if time.time() - path.stat().st_mtime < age
        ]
        for path in sorted(new, key=lambda path: path.stat().st_mtime)[-1:]:
            packed = base64.b64encode(gzip.compress(path.read_bytes(), mtime=0)).decode()
            say("%s, for `base64 -d | gunzip`: %s" % (path.name, packed))

    def add_total(self, name, inputs, seconds, crashes):
        """Adds a walk to totals.csv, in CI not; returns the text of the file."""
        today = datetime.datetime.now(datetime.timezone.utc).date().isoformat()
        path = ROOT / TOTALS
        with self.lock:
            text = path.read_text(encoding="utf-8")
            if not CI:
                sanitized = inputs if self.preset == SANITIZED else 0
                text = added_total(text, name, inputs, sanitized, seconds, crashes, today)
                path.write_text(text, encoding="utf-8")
        return text


def chosen_targets(name):
    """Returns the target of this name, with or without "_fuzz"; all without a name. Raises DevError
    for no target.
    """
    names = [each for each in target_names() if name in ("", each, each + "_fuzz")]
    if not names:
        raise DevError("no fuzz target '%s'; there is: %s" % (name, " ".join(target_names())))
    return names


MODES = ("fast", "replay", "shrink", "keep")


def fuzz_command(arguments):
    """Runs every fuzz target or one, for 60 s each by default; adds to tests/fuzz/totals.csv.

    Without a mode it goes on from what was found before, in build/fuzz/corpus. `fast` does so
    without sanitizers, several times as fast, and then gives what it found to those with them.
    Both end after SECONDS, or after N inputs. `replay` makes one pass over the kept inputs,
    tests/fuzz/corpus/*.pack. `shrink` keeps the fewest of the found inputs that reach all of the
    code reached so far. `keep TARGET FILE...` adds inputs to a target's pack, such as one that
    crashed before a correction.
    """
    words = list(arguments)
    if words[:1] in (["--help"], ["-h"]):
        workspace.parser(
            fuzz_command,
            "fuzz [fast | replay | shrink | keep] [TARGET] [SECONDS | --inputs N | FILE...]",
            add_help=False,
        ).print_help()
        return
    mode = words.pop(0) if words and words[0] in MODES else "walk"
    if mode == "keep" and len(words) < 2:
        raise DevError("usage: ./dev fuzz keep TARGET FILE...")
    limit = taken_limit(words) if mode in ("walk", "fast") else None
    target, files = (words + [""])[0], words[1:]
    if files and mode != "keep":
        raise DevError(
            "fuzz takes one target, not '%s'; `./dev fuzz --help` explains" % " ".join(words)
        )
    names = chosen_targets(target)
    packages.install(packages.BASE, packages.CLANG)
    if mode == "fast":
        Fuzzers(FAST, names).walk(limit)
    fuzzers = Fuzzers(SANITIZED, names)
    if mode == "fast":
        fuzzers.check_found()
    elif mode == "replay":
        fuzzers.replay()
    elif mode == "shrink":
        fuzzers.shrink()
    elif mode == "keep":
        fuzzers.keep(names[0], files)
    else:
        fuzzers.walk(limit)
