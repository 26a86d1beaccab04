#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the tables of bench/README.md from the rows under bench/results.

  table.py write PAGE.md              writes the page's tables anew
  table.py check PAGE.md              fails when a table is not what `write` would make it
  table.py stamp FOLDER ROWS.csv ...  records today's date and this commit for rows that were just
                                      measured
  table.py selftest

A table is in the page between two marks; the first names its kind and its file, relative to the
page:

  <!-- generated: begin; soil: results/amd-epyc-avx512-2-cores/soil.csv -->
  <!-- generated: end -->

FOLDER/measured.csv says when and at which commit each file was measured; a file that it does not
name is an error.
Standard library only.
"""
import csv
import datetime
import os
import re
import subprocess
import sys
import tempfile

# Tables marked csv are made by tools/docs.py.
BEGIN = re.compile(r"^<!-- generated: begin; (?!csv:)(\w+): (\S+) -->$")
END = "<!-- generated: end -->"


def read(path):
    try:
        with open(path, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))
    except OSError as error:
        sys.exit("table.py: %s" % error)


def number(row, column, scale=1.0, form="%.1f"):
    """A cell, or '-' where the bench does not measure it."""
    text = row.get(column) or ""
    return form % (float(text) * scale) if text else "-"


def per_processor_second(row):
    """Million particle-steps a second of processor time, all threads together."""
    if not row.get("processor_ms"):
        return "-"
    return "%.1f" % (
        float(row["particles"]) * float(row["steps"]) / float(row["processor_ms"]) / 1e3
    )


def soil(rows):
    yield (
        "bench",
        "particles",
        "M particle-steps/s",
        "slowest run",
        "kernels only",
        "a processor second",
        "of copy bandwidth",
        "of FMA peak",
        "real-time factor",
    )
    for row in rows:
        slowest = float(row["particle_steps_per_s"]) / (1 + float(row["spread"])) / 1e6
        yield (
            "`%s`" % row["bench"],
            row["particles"],
            number(row, "particle_steps_per_s", 1e-6),
            "%.1f" % slowest,
            number(row, "kernel_particle_steps_per_s", 1e-6),
            per_processor_second(row),
            number(row, "share_of_copy_bandwidth", form="%.2f"),
            number(row, "share_of_fma_peak", form="%.2f"),
            number(row, "real_time_factor"),
        )


def native(rows):
    """Row of the native loop, which precedes the OpenCL row of the same size."""
    yield (
        "particles",
        "native loop, M particle-steps/s and thread",
        "OpenCL steps",
        "ratio",
        "ratio by processor time",
    )
    for loop, ours in zip(rows[0::2], rows[1::2]):
        # The native loop runs one copy per thread; the OpenCL step shares one state among the
        # threads.
        threads = float(loop["particles"]) / float(ours["particles"])
        rate = [float(row["particle_steps_per_s"]) / threads / 1e6 for row in (loop, ours)]
        spent = [float(per_processor_second(row)) for row in (loop, ours)]
        yield (
            ours["particles"],
            "%.1f" % rate[0],
            "%.1f" % rate[1],
            "%.2f" % (rate[1] / rate[0]),
            "%.2f" % (spent[1] / spent[0]),
        )


def peers(rows):
    """Other codes, which follow our row of the same number of particles."""
    yield (
        "code",
        "particles",
        "threads",
        "time step [ms]",
        "M particle-steps/s",
        "a processor second",
        "Navvy / it",
        "by processor time",
        "real-time factor",
        "Navvy / it, simulated time",
        "simulated, by processor time",
    )
    ours = {}
    for row in rows:
        work = float(row["particles"]) * float(row["steps"]) / 1e6
        simulated = float(row["step_ms"]) * float(row["steps"]) / 1e3
        spent = [float(row[column]) for column in ("wall_s", "processor_s")]
        rate = [amount / time for amount in (work, simulated) for time in spent]
        first = ours.setdefault(row["particles"], rate)
        yield (
            " ".join((row["code"], row["version"])),
            row["particles"],
            row["threads"],
            "%.3g" % float(row["step_ms"]),
            "%.3g" % rate[0],
            "%.3g" % rate[1],
            "%.1f" % (first[0] / rate[0]),
            "%.1f" % (first[1] / rate[1]),
            "%.3g" % rate[2],
            "%.1f" % (first[2] / rate[2]),
            "%.1f" % (first[3] / rate[3]),
        )


def model(rows):
    """Rows of which a model of the cost of a step is made."""
    yield (
        "bench",
        "particles",
        "active blocks",
        "nodes near tools",
        "processor ms a step",
        "ns a particle-step",
    )
    for row in rows:
        step = float(row["processor_ms"]) / float(row["steps"])
        yield (
            "`%s`" % row["bench"],
            row["particles"],
            row["active_blocks"],
            row["contact_nodes"] or "0",
            "%.2f" % step,
            "%.0f" % (1e6 * step / float(row["particles"])),
        )


def scene(rows):
    yield "scene", "mean active particles", "least ms", "median ms", "real-time factor"
    for row in rows:
        yield (
            "`%s`" % row["bench"],
            row["particles"],
            number(row, "min_ms", form="%.0f"),
            number(row, "median_ms", form="%.0f"),
            number(row, "real_time_factor"),
        )


def host(rows):
    """Work of the host: machines, maps. A site's edge where it is what varies."""
    yield "bench", "site [m]", "least ms", "median ms", "of processor, ms", "real-time factor"
    for row in rows:
        yield (
            "`%s`" % row["bench"],
            row["site_m"] or "-",
            number(row, "min_ms"),
            number(row, "median_ms"),
            number(row, "processor_ms"),
            number(row, "real_time_factor"),
        )


def limits(rows):
    """Files of others at 64 MB and maps at their full size."""
    yield "file", "MiB", "s of processor", "memory, MiB", "status"
    for row in rows:
        yield row["file"], row["mib"], row["processor_s"], row["peak_mib"], row["status"]


def commands(rows):
    """Whole commands, timed by hand: rows of command, seconds, target, machine."""
    yield "command", "took [s]", "wanted", "where"
    for row in rows:
        yield row["what"], row["seconds"], row["wanted"] or "-", row["where"]


KINDS = {
    "soil": soil,
    "native": native,
    "peers": peers,
    "model": model,
    "scene": scene,
    "host": host,
    "limits": limits,
    "commands": commands,
}


def table(kind, path):
    """Lines of one table, with a line that gives device, date and revision of the measurement."""
    rows = read(path)
    if not rows:
        sys.exit("table.py: %s holds no rows" % path)
    folder, name = os.path.split(path)
    for noted in read(os.path.join(folder, "measured.csv")):
        if noted["file"] == name:
            break
    else:
        sys.exit(
            "table.py: %s/measured.csv has no date for the measurement of %s; `table.py stamp %s"
            " %s` does" % (folder, name, folder, name)
        )
    on = ", ".join(
        "%s, driver %s" % pair if pair[1] else pair[0]
        for pair in dict.fromkeys(
            (row["device"], row["driver"]) for row in rows if row.get("device")
        )
    )
    peaks = [
        max((float(row[column]) for row in rows if row.get(column)), default=0) / 1e9
        for column in ("copy_bytes_per_s", "fma_flops_per_s")
    ]
    lines = [
        "%s%s at %s.%s"
        % (
            on + "; " if on else "",
            noted["date"],
            noted["state"],
            " " + noted["note"] if noted["note"] else "",
        )
    ]
    if peaks[0]:
        lines[0] += " Highest peaks measured with it: copy %.0f GB/s, FMA %.0f GFLOP/s." % tuple(
            peaks
        )
    lines.append("")
    head, *body = KINDS[kind](rows)
    lines.append("| " + " | ".join(head) + " |")
    lines.append("|" + "---|" * len(head))
    lines += ["| " + " | ".join(cells) + " |" for cells in body]
    return lines


def rewritten(page):
    """The page with regenerated tables."""
    out, inside = [], False
    with open(page, encoding="utf-8") as file:
        for line in file.read().splitlines():
            found = BEGIN.match(line)
            if found:
                if found[1] not in KINDS:
                    sys.exit(
                        "table.py: %s: no kind of table '%s'; known kinds: %s"
                        % (page, found[1], ", ".join(KINDS))
                    )
                out += [line] + table(found[1], os.path.join(os.path.dirname(page), found[2]))
                inside = True
            elif line == END:
                out.append(line)
                inside = False
            elif not inside:
                out.append(line)
    if inside:
        sys.exit("table.py: %s: a table has no line '%s'" % (page, END))
    return "\n".join(out) + "\n"


def stamp(folder, names):
    path = os.path.join(folder, "measured.csv")
    rows = [row for row in read(path) if row["file"] not in names] if os.path.exists(path) else []
    state = subprocess.run(
        ["git", "describe", "--always"], capture_output=True, text=True, check=False
    ).stdout.strip()
    rows += [
        {
            "file": name,
            "date": datetime.date.today().isoformat(),
            "state": state or "unknown",
            "note": "",
        }
        for name in names
    ]
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, ["file", "date", "state", "note"], lineterminator="\n")
        writer.writeheader()
        writer.writerows(sorted(rows, key=lambda row: row["file"]))


def selftest():
    with tempfile.TemporaryDirectory() as folder:

        def put(name, text):
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(text)
            return os.path.join(folder, name)

        put(
            "n.csv",
            (
                "bench,device,driver,particles,steps,min_ms,spread,"
                "particle_steps_per_s,processor_ms\n"
                "native_loop:1k,D,1,2000,10,1,0,2e7,2\nours:1k,D,1,1000,10,1,0,3e7,1\n"
            ),
        )
        put(
            "p.csv",
            "code,version,threads,particles,steps,step_ms,wall_s,processor_s\n"
            "Navvy,1,2,1000,10,1.7,0.01,0.02\nOther,3,1,1000,10,0.02,0.1,0.1\n",
        )
        put(
            "measured.csv",
            "file,date,state,note\nn.csv,2026-01-01,abc,Quiet.\np.csv,2026-01-01,abc,\n",
        )
        other = table("peers", os.path.join(folder, "p.csv"))
        assert other[-1] == (
            "| Other 3 | 1000 | 1 | 0.02 | 0.1 | 0.1 | 10.0 | 5.0 | 0.002 | 850.0 | 425.0 |"
        ), other
        page = put("p.md", "# T\n<!-- generated: begin; native: n.csv -->\nold\n%s\nend\n" % END)
        text = rewritten(page)
        # Two copies of the loop: 10 M a thread; the OpenCL step: 15 M a thread; by processor time
        # 10 to 10.
        assert "| 1000 | 10.0 | 15.0 | 1.50 | 1.00 |" in text, text
        assert (
            "D, driver 1; 2026-01-01 at abc. Quiet." in text
            and "old" not in text
            and text.endswith("end\n")
        ), text
        put("p.md", text)
        assert rewritten(page) == text
    print("table.py: selftest passed")


def main():
    if len(sys.argv) == 2 and sys.argv[1] == "selftest":
        return selftest()
    if len(sys.argv) == 3 and sys.argv[1] in ("write", "check"):
        page, text = sys.argv[2], rewritten(sys.argv[2])
        with open(page, encoding="utf-8") as file:
            same = file.read() == text
        if sys.argv[1] == "check":
            return (
                0
                if same
                else "table.py: %s differs from its rows; run `bench/table.py write %s`"
                % (page, page)
            )
        with open(page, "w", encoding="utf-8") as file:
            file.write(text)
        return 0
    if len(sys.argv) > 3 and sys.argv[1] == "stamp":
        return stamp(sys.argv[2], sys.argv[3:])
    return __doc__


if __name__ == "__main__":
    sys.exit(main())
