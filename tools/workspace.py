# SPDX-License-Identifier: Apache-2.0
"""The source tree, its build folder and processes: what every command of `./dev` shares."""
import argparse
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
CI = os.environ.get("CI") in ("true", "1")
PRESET = "ci" if CI else "release"
BUILD = pathlib.Path("build") / PRESET
NAVVY = BUILD / "src" / "cli" / "navvy"
JOBS = int(os.environ.get("NAVVY_JOBS") or len(os.sched_getaffinity(0)))


class DevError(Exception):
    """Ends `./dev` with a message and a status; the message is empty when a program has printed its
    own.
    """

    def __init__(self, message="", status=1):
        super().__init__(message)
        self.status = status


def say(message):
    """Prints one line (or more) that begins with "dev:"."""
    print("dev: %s" % message, flush=True)


def run(*command, check=True, env=None, **options):
    """Runs a program in the root of the tree and returns its exit status.

    `env` holds variables to set on top of those of this process. Raises DevError with the program's
    status when it fails, unless `check` is false.
    """
    sys.stdout.flush()
    status = subprocess.run(
        [str(word) for word in command],
        cwd=ROOT,
        check=False,
        env={**os.environ, **(env or {})},
        **options
    ).returncode
    if check and status != 0:
        raise DevError(status=status if status > 0 else 128 - status)
    return status


def output(*command, check=True):
    """Returns what a program prints; empty when it fails and `check` is false."""
    done = subprocess.run(
        [str(word) for word in command],
        cwd=ROOT,
        text=True,
        check=False,
        stdout=subprocess.PIPE,
        stderr=None if check else subprocess.DEVNULL,
    )
    if done.returncode != 0:
        if check:
            raise DevError(status=done.returncode)
        return ""
    return done.stdout


def run_logged(log, *command, env=None):
    """Runs a program with its output in the file `log`; returns its exit status."""
    path = ROOT / log
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        return run(
            *command,
            check=False,
            env=env,
            stdin=subprocess.DEVNULL,
            stdout=file,
            stderr=subprocess.STDOUT
        )


def print_tail(log, lines=40):
    """Prints the last lines of a log file."""
    text = (ROOT / log).read_text(encoding="utf-8", errors="replace")
    print("\n".join(text.splitlines()[-lines:]), flush=True)


def clock(seconds):
    """Returns a duration as h:mm:ss."""
    seconds = int(round(seconds))
    return "%d:%02d:%02d" % (seconds // 3600, seconds // 60 % 60, seconds % 60)


def parser(command, usage, **options):
    """Returns an argument parser whose help is the docstring of the command's function."""
    lines = (command.__doc__ or "").strip().split("\n")
    description = "\n".join(
        [lines[0]] + [line[4:] if line.startswith("    ") else line for line in lines[1:]]
    )
    return argparse.ArgumentParser(
        prog="./dev " + usage.split()[0],
        usage="./dev " + usage,
        description=description,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        **options
    )
