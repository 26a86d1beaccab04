#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Collects results of the tests in results.csv and writes the tables of docs/validation.md.

  table.py collect RESULTS.csv CASE=LOG... [--state S] [--device D] [--date DAY]
                   [--seconds SECONDS.csv]
  table.py write RESULTS.csv PAGE.md    writes the page's tables anew
  table.py check RESULTS.csv PAGE.md    fails when a table is not what `write` would make it
  table.py summary RESULTS.csv PAGE.md  writes the table of one row per case that summary.csv, in
                                        the folder of RESULTS.csv, lists
  table.py check-summary RESULTS.csv PAGE.md
  table.py selftest

A table is in the page between two marks; the first names the cases it holds, as shell patterns:

  <!-- generated: begin; cases: Rest.* GranularLab.*/Rest -->
  <!-- generated: end -->

Every row of results.csv belongs to exactly one table. `collect` renews the rows of the cases in
the logs; a log without `CASE=` is the output of ctest with many tests. Two kinds of lines are read:
rows of tests/tolerances,
| quantity | measured | expected | tolerance | result | source |, and those of tests/values.h,
[ VALUE    ] quantity: measured M, expected E (source).
"""
import argparse
import collections
import csv
import fnmatch
import os
import re
import sys

COLUMNS = [
    "case",
    "quantity",
    "measured",
    "half",
    "expected",
    "tolerance",
    "result",
    "source",
    "seconds",
    "date",
    "device",
    "state",
]
RESULTS = {
    "ok": "within",
    "outside": "miss",
    "known deviation": "known deviation",
    "ok, table old": "within",
    "TOLERANCE MOVED": "miss",
}
BEGIN = re.compile(r"^<!-- generated: begin; cases: (.*) -->$")
SUMMARY = "<!-- generated: begin; summary -->"
END = "<!-- generated: end -->"
JUDGED = re.compile(r"^(?:\d+: )?\| (.*) \|$")
VALUE = re.compile(r"^(?:\d+: )?\[ VALUE    \] (.*): measured (\S+), expected (.*) \((.*)\)$")
RUNS = re.compile(r"^(?:\d+: )?\[ RUN      \] (\S+)")
TEST = re.compile(r"^\d+/\d+ Testing: (\S+)", re.M)
# Tests of the tolerances themselves, and the soil's tests repeated in the other schedule: no
# separate results.
NO_RESULTS = re.compile(r"ExpectBetween\.|test_soil_in_groups$")


def tidy(text):
    """Numbers without trailing zeros of %f."""
    return re.sub(r"\d+\.\d{6}(?!\d)", lambda found: found[0].rstrip("0").rstrip("."), text)


def read(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def save(path, rows):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def rows_of(text, case=None):
    """Rows of a test's output; `case` names rows without a case."""
    out, running, names = [], case, TEST if TEST.search(text) else RUNS
    for line in text.splitlines():
        line = line.rstrip()
        started = names.match(line) if case is None else None
        if started:
            running = started[1]
        value, judged = VALUE.match(line), JUDGED.match(line)
        if value:
            out.append(
                {
                    "case": running,
                    "quantity": tidy(value[1]),
                    "measured": value[2],
                    "expected": tidy(value[3]),
                    "tolerance": "",
                    "result": "value",
                    "source": value[4],
                }
            )
        elif judged:
            cells = [cell.strip() for cell in judged[1].split("|")]
            if len(cells) != 6 or cells[4] not in RESULTS:
                continue
            out.append(
                {
                    "case": running,
                    "quantity": cells[0],
                    "measured": cells[1],
                    "expected": cells[2],
                    "tolerance": " ".join(cells[3].split()),
                    "result": RESULTS[cells[4]],
                    "source": cells[5],
                }
            )
    return out


def collect(rows, found, seconds, date, device, state):
    """Returns `rows` with the rows of the cases in `found` replaced by those.

    Values entered for half the cell are kept."""
    half = {(row["case"], row["quantity"]): row["half"] for row in rows}
    fresh = collections.defaultdict(list)
    for row in found:
        if NO_RESULTS.match(row["case"]):
            continue
        key = (row["case"], row["quantity"])
        fresh[row["case"]].append(
            dict(
                row,
                half=half.get(key, ""),
                seconds=seconds.get(row["case"], ""),
                date=date,
                device=device,
                state=state,
            )
        )
    out = []
    for row in rows:
        if row["case"] not in fresh:
            out.append(row)
        elif fresh[row["case"]] is not None:
            out += fresh[row["case"]]
            fresh[row["case"]] = None
    for new in fresh.values():
        out += new or []
    return out


def shown_tolerance(tolerance):
    low, dots, high = tolerance.partition(" .. ")
    if not dots:
        return tolerance
    if low == "-inf":
        return "at most " + high
    if high == "inf":
        return "at least " + low
    return low if low == high else tolerance


def bold(text, row):
    return "**" + text + "**" if text and row["result"] in ("miss", "known deviation") else text


def merged(rows):
    """Returns `rows` with the rows of one quantity of a case with parameters (Case/0, Case/1 ...)
    merged into one, which shows the range from the smallest to the largest value."""
    out, place = [], {}
    for row in rows:
        family = re.sub(r"/\d+$", "/*", row["case"])
        key = (family, row["quantity"], row["expected"], row["tolerance"])
        if family == row["case"] or key not in place:
            place[key] = len(out)
            out.append(dict(row, values=[row["measured"]]))
            continue
        first = out[place[key]]
        first["values"].append(row["measured"])
        least, largest = min(first["values"], key=float), max(first["values"], key=float)
        first.update(case=family, measured=least if least == largest else least + " .. " + largest)
    return out


def table(rows):
    """Returns the Markdown of one table.

    A case whose name ends in Half becomes a column of the case that it repeats with half the cell.
    """
    rows = merged(rows)
    names = {row["case"] for row in rows}
    halves = {
        (row["case"][:-4], row["quantity"]): row
        for row in rows
        if row["case"].endswith("Half") and row["case"][:-4] in names
    }
    runs = []
    lines = [
        "| Case | Quantity | Measured | Half the cell | Expected | Tolerance | Source | s | Run |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    last = None
    for row in rows:
        if row["case"].endswith("Half") and row["case"][:-4] in names:
            continue
        run = (row["date"], row["state"], row["device"])
        if run not in runs:
            runs.append(run)
        half, seconds = row["half"], row["seconds"]
        finer = halves.get((row["case"], row["quantity"]))
        if finer:
            half = bold(finer["measured"], finer)
            seconds += "; half " + finer["seconds"] if finer["seconds"] else ""
        again = row["case"] == last
        last = row["case"]
        cells = [
            "" if again else row["case"],
            row["quantity"],
            bold(row["measured"], row),
            half,
            row["expected"],
            shown_tolerance(row["tolerance"]),
            row["source"],
            "" if again else seconds,
            "abcdefghijkl"[runs.index(run)],
        ]
        lines.append("| " + " | ".join(cells) + " |")
    lines.append("")
    for letter, (date, state, device) in zip("abcdefghijkl", runs):
        words = [date] + (["state " + state] if state else []) + ([device] if device else [])
        lines.append("- Run " + letter + ": " + ", ".join(words) + ".")
    return lines


def written(page, rows):
    """The page with its tables generated from `rows`, and faults of the marks."""
    out, wrong, taken, inside = [], [], collections.Counter(), False
    for line in page.splitlines():
        begin = BEGIN.match(line)
        if begin:
            if inside:
                wrong.append("a table begins within another: " + line)
            inside = True
            patterns = begin[1].split()
            mine = [
                row for row in rows if any(fnmatch.fnmatchcase(row["case"], p) for p in patterns)
            ]
            for case in {row["case"] for row in mine}:
                taken[case] += 1
            for pattern in patterns:
                if not any(fnmatch.fnmatchcase(row["case"], pattern) for row in rows):
                    wrong.append("no case is called " + pattern)
            out += [line] + table(mine)
        elif line == END:
            inside = False
            out.append(line)
        elif not inside:
            out.append(line)
    if inside:
        wrong.append("the last table does not end")
    for case in dict.fromkeys(row["case"] for row in rows):
        if taken[case] != 1:
            wrong.append("%s is in %d tables" % (case, taken[case]))
    return "\n".join(out) + "\n", wrong


def shown_result(row):
    if row["result"] == "known deviation":
        return "**no** (known)"
    return "**no**" if row["result"] == "miss" else "yes"


def rounded(text):
    """Numbers with four digits, for a table on one screen."""

    def shorter(found):
        if len(re.sub(r"\D", "", found[0])) < 5:
            return found[0]
        value = float(found[0])
        return "%.0f" % value if abs(value) >= 1000 else "%.4g" % value

    return re.sub(r"-?\d+\.?\d*(?:e[-+]?\d+)?", shorter, text)


def slug(heading):
    """Anchor of a heading, as GitHub and MyST make it."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def summary(rows, chosen):
    """Markdown of the chosen quantities, one row each, and faults of the choice."""
    found, wrong = {}, []
    for row in rows:
        found.setdefault((row["case"], row["quantity"]), row)
    lines = [
        "| Section | Case | Measured | Expected | Tolerance | Pass |",
        "|---|---|---|---|---|---|",
    ]
    last = None
    for choice in chosen:
        row = found.get((choice["case"], choice["quantity"]))
        if row is None:
            wrong.append("no result '%s' of %s" % (choice["quantity"], choice["case"]))
            continue
        section = choice["section"]
        link = "" if section == last else "[%s](validation.md#%s)" % (section, slug(section))
        last = section
        lines.append(
            "| "
            + " | ".join(
                [
                    link,
                    choice["what"],
                    bold(rounded(row["measured"]), row),
                    rounded(row["expected"]),
                    rounded(shown_tolerance(row["tolerance"])),
                    shown_result(row),
                ]
            )
            + " |"
        )
    counts = collections.Counter(row["result"] for row in rows)
    lines += [
        "",
        "Of all %d results with a tolerance of their own, %d are within it and %d are not; of"
        " these, %d are"
        % (
            sum(counts.values()) - counts["value"],
            counts["within"],
            counts["miss"] + counts["known deviation"],
            counts["known deviation"],
        ),
        "known deviations of automatic cases, and %d are runs of the laboratory by hand. Another %d"
        " results are" % (counts["miss"], counts["value"]),
        "asserted by their tests. Measured between %s and %s."
        % (min(row["date"] for row in rows), max(row["date"] for row in rows)),
    ]
    return lines, wrong


def with_summary(page, rows, chosen):
    """The page with the lines between its marks generated from `rows`, and faults."""
    begin, end = SUMMARY + "\n", END + "\n"
    head, found, rest = page.partition(begin)
    if not found or end not in rest:
        return page, ["no marks of a generated summary"]
    lines, wrong = summary(rows, chosen)
    return head + begin + "\n".join(lines) + "\n" + end + rest.partition(end)[2], wrong


def selftest():
    log = (
        "7: [ RUN      ] A.Holds\n7: | force [N] |  2 |  1 |  0 .. inf | known deviation | Rankine"
        " |\n[ VALUE    ] drag (dry): measured 3.5, expected 3 +-20 % (statics, as above)\n| Test |"
        " Value |\n"
    )
    rows = rows_of(log)
    assert [r["case"] for r in rows] == ["A.Holds", "A.Holds"], rows
    assert rows[0]["tolerance"] == "0 .. inf" and rows[0]["result"] == "known deviation", rows
    assert rows[1]["quantity"] == "drag (dry)" and rows[1]["source"] == "statics, as above", rows
    assert rows_of("1/2 Testing: C\n" + log)[0]["case"] == "C"
    finer = rows_of("| force [N] | 4 | 1 | 0 .. inf | ok | Rankine |", "A.HoldsHalf")
    kept = collect([], rows + finer, {"A.Holds": "2"}, "2026-01-02", "cpu", "abc")
    assert len(collect(kept, rows, {}, "2026-01-03", "cpu", "abc")) == 3
    page = "# t\n<!-- generated: begin; cases: A.* -->\nby hand\n<!-- generated: end -->\nprose\n"
    assert (
        merged([dict(kept[0], case="D/%d" % n, measured=str(n)) for n in (2, 0, 1)])[0]["measured"]
        == "0 .. 2"
    )
    assert tidy("20.000000 at 0.342020 of 0.50") == "20 at 0.34202 of 0.50"
    text, wrong = written(page, kept)
    assert not wrong and "by hand" not in text and text.endswith("prose\n"), (text, wrong)
    assert "| A.Holds | force [N] | **2** | 4 | 1 | at least 0 | Rankine | 2 | a |" in text, text
    assert written(text, kept)[0] == text
    assert rounded("26064 .. 31857.4, 1, 0.12703") == "26064 .. 31857, 1, 0.127"
    chosen = [
        {
            "section": "Rest, and stress",
            "what": "a force",
            "case": "A.Holds",
            "quantity": "force [N]",
        }
    ]
    page = SUMMARY + "\nold\n" + END + "\nprose\n"
    short, wrong = with_summary(page, kept, chosen)
    assert not wrong and "old" not in short and short.endswith("prose\n"), (short, wrong)
    assert (
        "[Rest, and stress](validation.md#rest-and-stress) | a force | **2** | 1 | at least 0 |"
        " **no**"
        in short
    ), short
    assert with_summary(page, kept, [dict(chosen[0], quantity="x")])[1] == [
        "no result 'x' of A.Holds"
    ]
    assert written(text, kept + [dict(kept[0], case="B")])[1] == ["B is in 0 tables"]
    assert written("<!-- generated: begin; cases: C.* -->\n", [])[1] == [
        "no case is called C.*",
        "the last table does not end",
    ]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "command", choices=["collect", "write", "check", "summary", "check-summary", "selftest"]
    )
    parser.add_argument("results", nargs="?")
    parser.add_argument("rest", nargs="*")
    parser.add_argument("--date", default="")
    parser.add_argument("--device", default="")
    parser.add_argument("--state", default="")
    parser.add_argument("--seconds", action="append", default=[])
    options = parser.parse_intermixed_args()
    if options.command == "selftest":
        return selftest()
    rows = read(options.results)
    if options.command == "collect":
        seconds, found = {}, []
        for path in options.seconds:
            with open(path, newline="") as file:
                for row in csv.reader(file):
                    seconds.setdefault(row[0], row[1])
        for argument in options.rest:
            case, _, path = argument.rpartition("=")
            with open(path, errors="replace") as file:
                found += rows_of(file.read(), case or None)
        save(
            options.results,
            collect(rows, found, seconds, options.date, options.device, options.state),
        )
        return None
    path = options.rest[0]
    with open(path) as file:
        before = file.read()
    if options.command in ("summary", "check-summary"):
        chosen = read(os.path.join(os.path.dirname(options.results), "summary.csv"))
        after, wrong = with_summary(before, rows, chosen)
    else:
        after, wrong = written(before, rows)
    for line in wrong:
        print("%s: %s" % (path, line), file=sys.stderr)
    if options.command in ("write", "summary"):
        with open(path, "w") as file:
            file.write(after)
    elif before != after:
        wrong.append("edited")
        print(
            "%s: a table differs from %s: ./dev docs writes it" % (path, options.results),
            file=sys.stderr,
        )
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
