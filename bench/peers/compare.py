#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures Navvy beside other codes in one run: compare.py NAVVY ROWS.csv [--rounds N].

A block of sand collapses in each: as MLS-MPM with a Drucker-Prager law in Taichi and Warp, with the
cells, particles and time step of Navvy's case `soil_collapse_no_tool`; with the same cells and
particles by Newton's implicit MPM, whose steps are ten times longer; as grains with friction in
LAMMPS and YADE, which need time steps eighty times shorter. Taichi, Warp and Newton come from PyPI
into a virtual environment that this script makes (Newton's first run compiles for minutes); LAMMPS
and YADE are Debian packages (apt-get install lammps yade). A code that is missing is named and left
out. Codes run in turn, --rounds times; the least wall time and the least processor time count.
Rates are particle-steps per second. A step of one code is not the work of a step of another one, so
the real-time factor, simulated time over wall time, stands beside them.
"""
import argparse
import csv
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
# Of each code in Python: our script, the module that it imports and the PyPI package of that.
SCRIPTS = {
    "Taichi": ("taichi_mpm.py", "taichi", "taichi==1.7.4"),
    "Warp": ("warp_mpm.py", "warp", "warp-lang==1.19.0"),
    "Newton": ("newton_mpm.py", "newton", "newton==1.8.0"),
}
COLUMNS = (
    "code,version,threads,particles,steps,step_ms,wall_s,processor_s,first_steps_s,"
    "copy_bytes_per_s,fma_flops_per_s"
).split(",")
# Edges of the blocks in particles, and the case of Navvy of that size.
SIZES = {"27k": 30, "216k": 60}
# Largest block of a code whose set-up of larger ones takes minutes.
LARGEST = {"YADE": "27k"}
# Particle-steps that a run of each code takes, so that each takes some seconds. Newton's simulate
# about as much of the collapse as Navvy's.
WORK = {"Taichi": 2e6, "Warp": 2e6, "Newton": 3e5, "LAMMPS": 8e6, "YADE": 1e6}


def output_of(command, **variables):
    """Runs a program and returns what it prints; raises CalledProcessError when it fails."""
    done = subprocess.run(
        [str(word) for word in command],
        text=True,
        check=True,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        env={**os.environ, **variables},
    )
    return done.stdout


def reported(text):
    """Returns the result that one of our scripts printed."""
    return json.loads(re.search(r"^PEER (.*)$", text, re.M)[1])


def run_navvy(navvy, size):
    """Returns the row of `navvy bench` for a block of this size, and its peaks."""
    with tempfile.TemporaryDirectory() as folder:
        rows = pathlib.Path(folder) / "rows.csv"
        output_of([navvy, "bench", "soil_collapse_no_tool:" + size, "--csv", rows])
        with open(rows, newline="", encoding="utf-8") as file:
            (row,) = csv.DictReader(file)
    steps = int(row["steps"])
    return {
        "version": output_of([navvy, "--version"]).split()[-1],
        "threads": len(os.sched_getaffinity(0)),
        "particles": int(row["particles"]),
        "steps": steps,
        "step_ms": float(row["real_time_factor"]) * float(row["min_ms"]) / steps,
        "wall_s": float(row["min_ms"]) / 1e3,
        "processor_s": float(row["processor_ms"]) / 1e3,
        "copy_bytes_per_s": row["copy_bytes_per_s"],
        "fma_flops_per_s": row["fma_flops_per_s"],
    }


def run_python(python, script, particles, steps):
    """Returns the result of a script in the virtual environment."""
    threads = len(os.sched_getaffinity(0))
    options = ["--particles", particles, "--steps", steps, "--threads", threads]
    return reported(output_of([python, "-B", HERE / script, *options]))


def run_lammps(along, steps):
    """Returns the result of LAMMPS, which runs in one process."""
    options = ["-var", "along", along, "-var", "steps", steps, "-log", "none"]
    text = output_of(["lmp", "-in", HERE / "lammps_grains.in", *options], OMP_NUM_THREADS="1")
    loops = re.findall(r"^Loop time of (\S+) on .* with (\d+) atoms", text, re.M)
    shares = re.findall(r"^(\S+)% CPU use", text, re.M)
    wall = float(loops[-1][0])
    return {
        "version": re.search(r"^LAMMPS \(([^)]*)\)", text, re.M)[1],
        "threads": 1,
        "particles": int(loops[-1][1]),
        "steps": steps,
        "step_ms": 0.02,
        "wall_s": wall,
        "processor_s": wall * float(shares[-1]) / 100,
    }


def run_yade(along, steps):
    """Returns the result of YADE."""
    threads = len(os.sched_getaffinity(0))
    text = output_of(
        ["yade", "-x", "-n", "-j%d" % threads, HERE / "yade_grains.py"],
        PEER_ALONG=str(along),
        PEER_STEPS=str(steps),
    )
    version = re.search(r"Welcome to Yade (\S+)", text)
    return {"version": version[1] if version else "", "threads": threads, **reported(text)}


def made_environment(folder):
    """Makes the virtual environment and installs what it lacks; returns its Python and the names
    of the codes that it has.
    """
    python = folder / "bin" / "python"
    names = []
    for name, (_, module, package) in SCRIPTS.items():
        check = [python, "-c", "import numpy, " + module]
        try:
            if not python.is_file():
                output_of([sys.executable, "-m", "venv", folder])
            if subprocess.run(check, capture_output=True, check=False).returncode != 0:
                output_of([python, "-m", "pip", "install", "-q", package, "numpy"])
        except (OSError, subprocess.CalledProcessError) as error:
            detail = getattr(error, "output", None) or str(error)
            print(
                "compare.py: left out %s, which needs the PyPI packages %s and numpy:\n%s"
                % (name, package, detail.strip())
            )
        else:
            names.append(name)
    return python, names


def codes(navvy, environment):
    """Returns what runs each code that is installed, by name; Navvy comes first."""

    def steps(name, along):
        return max(5, round(WORK[name] / along**3))

    out = {"Navvy": lambda size, along: run_navvy(navvy, size)}
    python, names = made_environment(environment)
    for name in names:
        out[name] = lambda size, along, name=name: run_python(
            python, SCRIPTS[name][0], along**3, steps(name, along)
        )
    for name, program, run in (("LAMMPS", "lmp", run_lammps), ("YADE", "yade", run_yade)):
        if shutil.which(program):
            out[name] = lambda size, along, name=name, run=run: run(along, steps(name, along))
        else:
            print("compare.py: left out %s: apt-get install %s" % (name, name.lower()))
    return out


def better(one, other):
    """Returns the row with the least times of two rows of one code and size."""
    if one is None:
        return other
    out = dict(other)
    for column in ("wall_s", "processor_s"):
        out[column] = min(one[column], other[column])
    return out


def rates(row):
    """Returns million particle-steps per second of wall time and of processor time."""
    work = row["particles"] * row["steps"] / 1e6
    return work / row["wall_s"], work / row["processor_s"]


def paces(row):
    """Returns simulated time over wall time and over processor time."""
    simulated = row["step_ms"] * row["steps"] / 1e3
    return simulated / row["wall_s"], simulated / row["processor_s"]


def print_table(rows):
    """Prints the rates, and those of Navvy over them; then the same of simulated time."""
    over = ("Navvy over", "by processor")
    form = "%-7s %9s %8s %8s" + " %15s %15s %12s %12s" * 2
    heads = ("code", "particles", "threads", "step ms", "M/s, wall", "M/s, processor", *over)
    print(form % (*heads, "real time, wall", "by processor", *over))
    ours = {}
    for row in rows:
        # Navvy's row of each size comes first.
        here = rates(row), paces(row)
        first = ours.setdefault(row["particles"], here)
        cells = ["%.3g" % row["step_ms"]]
        for mine, other in zip(first, here):
            cells += ["%.3g" % value for value in other]
            cells += ["%.1f" % (one / two) for one, two in zip(mine, other)]
        print(form % (row["code"], row["particles"], row["threads"], *cells))


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("navvy", help="the program, such as build/release/src/cli/navvy")
    parser.add_argument("rows", help="CSV file to write")
    parser.add_argument("--rounds", type=int, default=3, help="runs of each code (default 3)")
    parser.add_argument("--sizes", default="27k,216k", help="of %s" % ",".join(SIZES))
    parser.add_argument(
        "--environment",
        type=pathlib.Path,
        default=HERE.parents[1] / "build" / "peers",
        help="folder of the virtual environment (default build/peers)",
    )
    options = parser.parse_args()
    sizes = options.sizes.split(",")
    if not set(sizes) <= set(SIZES):
        parser.error("--sizes: '%s' is not of %s" % (options.sizes, ",".join(SIZES)))
    run = codes(options.navvy, options.environment)
    best = {}
    for number in range(options.rounds):
        for size in sizes:
            for name, each in run.items():
                if LARGEST.get(name, size) != size:
                    continue
                print("round %d: %s, %s particles" % (number + 1, name, size), flush=True)
                try:
                    row = {"code": name, **each(size, SIZES[size])}
                except subprocess.CalledProcessError as error:
                    sys.exit("compare.py: %s failed:\n%s" % (name, error.output[-2000:]))
                best[size, name] = better(best.get((size, name)), row)
    rows = [best[size, name] for size in sizes for name in run if (size, name) in best]
    print_table(rows)
    with open(options.rows, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(
            file, COLUMNS, restval="", extrasaction="ignore", lineterminator="\n"
        )
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    main()
