# SPDX-License-Identifier: Apache-2.0
"""`./dev format` and `./dev lint`: clang-format, clang-tidy and the style tests."""
import concurrent.futures
import json
import subprocess

import build
import packages
import workspace
from workspace import BUILD, JOBS, ROOT, DevError, say

# Host tests and fuzz targets are built by clang with the same precompiled headers.
CLANG_PRESET = "fuzz"
CHECKED_SOURCES = ["src/*.cpp", "tests/*.cpp", "bench/*.cpp"]
OUR_SOURCES = [
    "src/*.h",
    "src/*.cpp",
    "tests/*.h",
    "tests/*.cpp",
    "bench/*.h",
    "bench/*.cpp",
    "examples/*.cpp",
]


def in_threads(function, items):
    """Calls a function for each item, JOBS at a time; returns the results in order."""
    with concurrent.futures.ThreadPoolExecutor(JOBS) as pool:
        return list(pool.map(function, items))


def format_command(arguments):
    """Formats all our C++ with clang-format; with --check only tests whether it is formatted."""
    parser = workspace.parser(format_command, "format [--check]")
    parser.add_argument(
        "--check", action="store_true", help="change nothing; fail when a file is not formatted"
    )
    options = ["--dry-run", "-Werror"] if parser.parse_args(arguments).check else ["-i"]
    packages.install(packages.FORMAT)
    files = workspace.output(
        "git", "ls-files", "-co", "--exclude-standard", "--", *OUR_SOURCES
    ).split()
    files = [file for file in files if (ROOT / file).is_file()]
    groups = [files[i : i + 20] for i in range(0, len(files), 20)]
    if any(
        in_threads(
            lambda group: workspace.run("clang-format", *options, *group, check=False), groups
        )
    ):
        raise DevError("some files are not formatted: ./dev format")


def git_line(*arguments):
    """Returns the first line of git's output; empty when git fails."""
    return (workspace.output("git", *arguments, check=False).splitlines() or [""])[0]


def base_commit():
    """Returns the merge base with main, or the twentieth last commit when this is main itself:
    changes land in dozens of commits, and three of them may hold no source at all.
    """
    head = git_line("rev-parse", "HEAD")
    for main in ("origin/main", "main"):
        base = git_line("merge-base", "HEAD", main)
        if base and base != head:
            return base
    return git_line("rev-parse", "-q", "--verify", "HEAD~20") or git_line(
        "rev-list", "--max-parents=0", "HEAD"
    )


def most_changed_first(numstat):
    """Returns the files of `git diff --numstat`, those with most changed lines first."""
    rows = [line.split("\t") for line in numstat.splitlines()]
    return [
        path
        for added, removed, path in sorted(
            rows, key=lambda row: (-(int(row[0]) + int(row[1])), row[2])
        )
        if path
    ]


def all_sources():
    """Returns the sources that are checked when nothing else is asked for."""
    return workspace.output("git", "ls-files", "--", *CHECKED_SOURCES).split()


def changed_sources():
    """Returns the sources that differ from the base commit; all in a clone without history."""
    base = base_commit()
    if base == git_line("rev-parse", "HEAD"):
        return all_sources()
    return most_changed_first(
        workspace.output(
            "git", "diff", "--numstat", "--no-renames", "--diff-filter=d", base, "--", "*.cpp"
        )
    )


def compiled_sources():
    """Returns the files that clang's build compiles, relative to the root: only these have flags to
    be checked with.
    """
    with open(ROOT / "build" / CLANG_PRESET / "compile_commands.json", encoding="utf-8") as file:
        paths = [entry["file"] for entry in json.load(file)]
    prefix = str(ROOT) + "/"
    return {path[len(prefix) :] for path in paths if path.startswith(prefix)}


def tidy(file):
    """Checks one file with clang-tidy; prints what it finds and returns whether it is clean."""
    done = subprocess.run(
        ["clang-tidy", "-p", "build/" + CLANG_PRESET, "--quiet", "--warnings-as-errors=*", file],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        check=False,
    )
    if done.stdout:
        print(done.stdout, flush=True)
    return done.returncode == 0


def lint_command(arguments):
    """Checks changed sources with clang-tidy, then runs the style tests.

    Sources that changed since the merge base with main are checked by default. Uses the flags and
    precompiled headers of clang's build, build/fuzz.
    """
    parser = workspace.parser(lint_command, "lint [--all | --at-most N | FILE...]")
    parser.add_argument("--all", action="store_true", help="every source of src, tests and bench")
    parser.add_argument(
        "--at-most",
        type=int,
        metavar="N",
        help="the N files that changed most; the others are named",
    )
    parser.add_argument("file", nargs="*", help="only these files")
    options = parser.parse_args(arguments)
    packages.install(packages.BASE, packages.CLANG)
    build.configure(CLANG_PRESET)
    files = options.file or (all_sources() if options.all else changed_sources())
    compiled = compiled_sources()
    files = [file for file in files if file in compiled]
    left = files[options.at_most :] if options.at_most is not None else []
    files = files[: len(files) - len(left)]
    if left:
        say(
            "lint: %d of %d changed files, those that changed most; `./dev nightly` checks all; "
            "left out: %s"
            % (len(files), len(files) + len(left), " ".join(left))
        )
    say("clang-tidy over %d files" % len(files))
    if files:
        build.build_precompiled(CLANG_PRESET)
        if not all(in_threads(tidy, files)):
            raise DevError("lint failed")
    build.build("test_style")
    workspace.run(BUILD / "tests" / "style" / "test_style", "--gtest_brief=1")
