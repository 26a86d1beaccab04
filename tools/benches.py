# SPDX-License-Identifier: Apache-2.0
"""`./dev bench`: the benches and the table of bench/README.md."""
import os
import pathlib
import re
import sys
import time

import build
import packages
import workspace
from workspace import BUILD, NAVVY, ROOT, DevError, say

# Benches that are no program of their own. The last one installs packages of others and runs on
# request only.
SCRIPTED = ("navvy_bench", "native_bench", "limits_bench", "peers_bench")


def machine_name():
    """Returns what the machine is called in bench/results: NAVVY_MACHINE, or its processor and how
    many of them.
    """
    name = os.environ.get("NAVVY_MACHINE")
    if not name:
        cpuinfo = pathlib.Path("/proc/cpuinfo")
        found = re.search(
            r"^model name[^:]*: *(.*)$",
            cpuinfo.read_text() if cpuinfo.is_file() else "",
            re.MULTILINE,
        )
        name = "%s-%d" % (found[1] if found else "unknown", os.cpu_count() or 1)
    return re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")


def bench_programs():
    """Returns the bench programs that are built, without those whose source is gone."""
    return sorted(
        path
        for path in (ROOT / BUILD / "bench").glob("*/*_bench")
        if os.access(path, os.X_OK)
        and (ROOT / "bench" / path.parent.name / (path.name + ".cpp")).is_file()
    )


def run_program(program, results, header):
    """Runs one bench program; its rows go to a CSV file of its name, except those of Google
    Benchmark.
    """
    name = program.name.removesuffix("_bench")
    say(program.name)
    if name == "primitives":
        workspace.run(
            program, "--benchmark_out=%s/primitives.json" % results, "--benchmark_out_format=json"
        )
        return
    csv = results / ("soil_kernels.csv" if name == "soil" else name + ".csv")
    (ROOT / csv).write_text(header + "\n", encoding="utf-8")
    workspace.run(program, env={"NAVVY_BENCH_CSV": str(csv)})


def bench_command(arguments):
    """Builds, then runs the benches; rows go to bench/results/<machine>/.

    Without NAME all run, with it those whose name holds it. Options go on to `navvy bench`
    (--device D, --quick). bench/README.md explains the rows. NAVVY_MACHINE names the machine.
    """
    if arguments[:1] in (["--help"], ["-h"]):
        workspace.parser(
            bench_command, "bench [NAME] [--device D] [--quick]", add_help=False
        ).print_help()
        return
    options = list(arguments)
    name = options.pop(0) if options and not options[0].startswith("-") else ""
    packages.install(packages.BASE, packages.BENCH)
    build.build("navvy_benches", "navvy")
    programs = [program for program in bench_programs() if name in program.name]
    scripted = [bench for bench in SCRIPTED if name in bench and (name or bench != "peers_bench")]
    if not programs and not scripted:
        raise DevError(
            "no bench matches '%s'; there is: %s"
            % (name, " ".join([*SCRIPTED, *(program.name for program in bench_programs())]))
        )
    results = pathlib.Path("bench") / "results" / machine_name()
    (ROOT / results).mkdir(parents=True, exist_ok=True)
    begun = time.time()
    if "navvy_bench" in scripted:
        workspace.run(
            NAVVY, "bench", *options, "--csv", results / "soil.csv", "--json", results / "soil.json"
        )
    if "native_bench" in scripted:
        workspace.run(NAVVY, "bench", "--native", "--csv", results / "native.csv")
    if "peers_bench" in scripted:
        packages.install(packages.READERS, packages.PEERS)
        workspace.run(
            sys.executable, "-B", "bench/peers/compare.py", NAVVY, results / "peers.csv"
        )
    if "limits_bench" in scripted:
        workspace.run(sys.executable, "-B", "bench/limits.py", NAVVY, results / "limits.csv")
    header = workspace.output(NAVVY, "bench", "--columns").strip()
    for program in programs:
        run_program(program, results, header)
    written = sorted(
        path.name
        for path in (ROOT / results).glob("*.csv")
        if path.stat().st_mtime >= begun and path.name != "measured.csv"
    )
    workspace.run(sys.executable, "-B", "bench/table.py", "stamp", results, *written)
    workspace.run(sys.executable, "-B", "bench/table.py", "write", "bench/README.md")
    say(
        "rows are in %s; bench/compare.py A.csv B.csv compares two machines or commits, "
        "bench/plot.py draws them"
        % results
    )
