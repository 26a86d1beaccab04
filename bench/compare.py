#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Prints two files of bench rows side by side: compare.py A.csv B.csv [--column min_ms].

Rows are matched by bench, device and driver; where a bench ran on one device in each file, by
bench alone, so that two machines can be compared. Ratios are B / A. A changed state hash is marked:
then the two did not do the same work. Standard library only.
"""
import argparse
import csv
import sys


def read(path):
    """Rows by (bench, device, driver); a later row of the same key wins."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
    except OSError as error:
        sys.exit("compare.py: %s" % error)
    if not rows or "bench" not in rows[0]:
        sys.exit(
            "compare.py: %s holds no bench rows (wanted: a header with a column 'bench')" % path
        )
    return {(r["bench"], r.get("device", ""), r.get("driver", "")): r for r in rows}


def pair(a, b):
    """Yields (row of A, row of B), either may be None."""
    used = set()
    for key, row in a.items():
        match = key if key in b else None
        if match is None:
            same = [k for k in b if k[0] == key[0]]
            if len(same) == 1 and sum(k[0] == key[0] for k in a) == 1:
                match = same[0]
        if match is not None:
            used.add(match)
        yield row, b.get(match) if match is not None else None
    for key, row in b.items():
        if key not in used:
            yield None, row


def number(row, column):
    try:
        return float(row[column]) if row else None
    except (KeyError, ValueError):
        return None


def main():
    parser = argparse.ArgumentParser(
        description="Two files of bench rows side by side; ratios are B / A."
    )
    parser.add_argument("a")
    parser.add_argument("b")
    parser.add_argument("--column", default="min_ms", help="what to compare (default min_ms)")
    options = parser.parse_args()
    print(
        "%-22s %-26s %12s %12s %7s  %s"
        % ("bench", "device", "A " + options.column, "B", "B / A", "")
    )
    shown = 0
    for row_a, row_b in pair(read(options.a), read(options.b)):
        one = row_a or row_b
        x, y = number(row_a, options.column), number(row_b, options.column)
        if x is None and y is None:
            continue
        shown += 1
        note = "only in A" if row_b is None else "only in B" if row_a is None else ""
        if row_a and row_b and row_a.get("state_hash") != row_b.get("state_hash"):
            note = "state hash differs"
        ratio = "%.3f" % (y / x) if x and y is not None else ""
        text = ["" if v is None else "%.5g" % v for v in (x, y)]
        print(
            "%-22s %-26s %12s %12s %7s  %s"
            % (one["bench"], one.get("device", "")[:26], *text, ratio, note)
        )
    if shown == 0:
        sys.exit("compare.py: no row has a number in column '%s'" % options.column)


if __name__ == "__main__":
    main()
