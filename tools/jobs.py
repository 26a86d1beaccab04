# SPDX-License-Identifier: Apache-2.0
"""`./dev jobs`: the jobs of record, from one start or from many."""
import concurrent.futures
import json
import pathlib
import random
import re
import shutil

import build
import packages
import workspace
from workspace import BUILD, JOBS, ROOT, DevError, say

FOLDER = BUILD / "jobs"
# Hills of 4 cm, whose seed is that of the run; and how far a soil differs from the shipped one.
HILLS = "<hills><height_m>0.04</height_m><wavelength_m>5</wavelength_m></hills></navvy:ground>"
COHESION, FRICTION = 0.15, 1.5
COLUMNS = "%-22s %-10s %6s %6s %7s %7s %7s %6s %6s %8s %5s  %s"


def names():
    """Returns the names of the jobs of record."""
    return sorted(path.stem for path in (ROOT / "scenarios" / "jobs").glob("*.sdf"))


def varied(job, seed):
    """Writes the scene of a job on uneven ground; returns its path and the options of its soil."""
    text = (ROOT / "scenarios" / "jobs" / (job + ".sdf")).read_text(encoding="utf-8")
    path = ROOT / FOLDER / ("%s_%d.sdf" % (job, seed))
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text.replace("</navvy:ground>", HILLS, 1), encoding="utf-8")
    draw = random.Random(seed)
    soil = workspace.output(workspace.NAVVY, "soils", re.search(r'soil ref="(\w+)"', text)[1])
    options = ["--seed", seed]
    for name, spread in (("cohesion_pa", None), ("friction_angle_deg", FRICTION)):
        value = float(re.search(r"%s\W+([0-9.]+)" % name, soil)[1])
        change = draw.uniform(-1, 1) * (spread or COHESION * value)
        options += ["--set", "soil.%s=%.4g" % (name, value + change)]
    return path, options


def run_job(job, seed, options):
    """Runs a job once and returns its row; `seed` 0 is the scene as it is shipped."""
    scene, more = (varied(job, seed)) if seed else (ROOT / "scenarios/jobs" / (job + ".sdf"), [])
    name = "%s_%d" % (job, seed) if seed else job
    out = ROOT / FOLDER / "runs" / name
    shutil.rmtree(out, ignore_errors=True)
    status = workspace.run_logged(
        FOLDER / (name + ".log"),
        workspace.NAVVY, "run", scene, "--out", out, "--quiet", *more, *options,
        env={"POCL_MAX_PTHREAD_COUNT": "1"},
    )  # fmt: skip
    path = out / "summary.json"
    summary = json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}
    return name, status, summary


def row_text(name, status, summary):
    """Returns the line of a run in the table."""
    score = summary.get("score", {})
    shape, loads = score.get("shape", {}), score.get("loads", {})

    def number(value, form, factor=1):
        return "-" if value is None else form % (factor * value)

    missed = [goal["goal"] for goal in summary.get("goals", []) if not goal["met"]]
    return COLUMNS % (
        name,
        summary.get("status", "exit %d" % status),
        number(score.get("work_time_s"), "%.0f"),
        number(summary.get("cycles"), "%d"),
        number(shape.get("volume_error"), "%+.3f"),
        number(shape.get("rms_error_m"), "%.3f"),
        number(shape.get("over_dig_rms_m"), "%.3f"),
        number(shape.get("completion"), "%.3f"),
        number(loads.get("load_error"), "%.3f"),
        number(loads.get("spilt_kg"), "%.0f"),
        number(summary.get("real_time_factor"), "%.2f"),
        "misses " + ", ".join(missed) if missed else "",
    )


def jobs_command(arguments):
    """Runs the jobs of record in scenarios/jobs to their ends and prints their scores.

    Without names all of them. --seeds N runs each N times, on hills of 4 cm and with soils of up to
    15 % more or less cohesion and 1.5 deg of friction. NAVVY_JOBS runs at a time, one thread each;
    their folders are in build/release/jobs/runs. Hours on two cores. Fails if a run misses a goal
    of its scene or does not end by itself.
    """
    parser = workspace.parser(jobs_command, "jobs [NAME...] [--seeds N] [-- options of navvy run]")
    parser.add_argument("names", nargs="*", metavar="NAME", help="a job: " + ", ".join(names()))
    parser.add_argument("--seeds", type=int, default=0, metavar="N", help="starts of each job")
    if "--" in arguments:
        at = arguments.index("--")
        arguments, options = arguments[:at], arguments[at + 1 :]
    else:
        options = []
    parsed = parser.parse_args(arguments)
    unknown = sorted(set(parsed.names) - set(names()))
    if unknown:
        raise DevError("unknown job '%s'; there are %s" % (unknown[0], ", ".join(names())))
    packages.install(packages.BASE)
    build.build("navvy")
    seeds = range(1, parsed.seeds + 1) if parsed.seeds else [0]
    todo = [(job, seed) for job in parsed.names or names() for seed in seeds]
    say("%d runs, %d at a time; each takes minutes to an hour" % (len(todo), JOBS))
    heads = ("run", "status", "time_s", "cycles", "volume", "rms_m", "over_m", "done", "load",
             "spilt_kg", "rtf", "")  # fmt: skip
    print(COLUMNS % heads)
    good = 0
    with concurrent.futures.ThreadPoolExecutor(JOBS) as pool:
        for done in concurrent.futures.as_completed(
            pool.submit(run_job, job, seed, options) for job, seed in todo
        ):
            name, status, summary = done.result()
            good += status == 0
            print(row_text(name, status, summary), flush=True)
    say("%d of %d runs ended by themselves and met their goals" % (good, len(todo)))
    if good < len(todo):
        raise DevError("the folders of the runs are in %s" % pathlib.Path(FOLDER / "runs"))
