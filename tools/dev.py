# SPDX-License-Identifier: Apache-2.0
"""The commands of `./dev`: one row each."""
import sys

import benches
import build
import campaigns
import fuzz
import gpu_check
import jobs
import lint
import nightly
import packages
import sanitize
import scene_run
import testing
import validate
import wheel
import workspace


def docs_command(arguments):
    """Renews generated pages, checks links and builds the site in build/docs/site.

      --check   changes nothing: fails when a generated page is stale or a link leads nowhere
      --pages   checks links and the tables that need no built program

    Without options the values of the last whole `./dev test` go into docs/validation.md first.
    """
    if arguments[:1] in (["--help"], ["-h"]):
        workspace.parser(docs_command, "docs [--check | --pages]", add_help=False).print_help()
        return
    if not arguments:
        packages.install(packages.DOCS)
        if (workspace.ROOT / workspace.BUILD / "test.log").is_file():
            validate.keep_values(workspace.BUILD / "test.log")
    workspace.run(sys.executable, "-B", "tools/docs.py", *arguments)


COMMANDS = {
    "run": scene_run.run_command,
    "test": testing.test_command,
    "validate": validate.validate_command,
    "build": build.build_command,
    "bench": benches.bench_command,
    "gpu-check": gpu_check.gpu_check_command,
    "docs": docs_command,
    "format": lint.format_command,
    "lint": lint.lint_command,
    "fuzz": fuzz.fuzz_command,
    "fault": campaigns.fault_command,
    "soak": campaigns.soak_command,
    "jobs": jobs.jobs_command,
    "sanitize": sanitize.sanitize_command,
    "nightly": nightly.nightly_command,
    "readers": campaigns.readers_command,
    "python": wheel.python_command,
    "install": packages.install_command,
}


def usage():
    """Returns the text of `./dev help`: the first line of each command's documentation."""
    rows = [
        "  %-9s %s" % (name, command.__doc__.strip().split("\n")[0])
        for name, command in COMMANDS.items()
    ]
    return "\n".join(
        [
            "./dev COMMAND [--no-install] [arguments]",
            "",
            *rows,
            "  help      Prints this text.",
            "",
            "`./dev COMMAND --help` explains a command. Missing packages are installed first",
            "(as root or through sudo) unless --no-install is given.",
            "",
            "Environment:",
            "  CI=true       builds with warnings as errors into build/ci instead of build/release",
            "  NAVVY_DEVICE  picks the OpenCL device: cpu, gpu, an index, a part of a name",
            "  NAVVY_JOBS    bounds the processes of a build or test run",
        ]
    )


def main(arguments):
    """Runs one command; returns the exit status."""
    packages.enabled = "--no-install" not in arguments
    words = [word for word in arguments if word != "--no-install"]
    name = words[0] if words else "help"
    if name in ("help", "-h", "--help"):
        print(usage())
        return 0
    if name not in COMMANDS:
        print("%s\ndev: unknown command '%s'" % (usage(), name), file=sys.stderr)
        return 1
    try:
        COMMANDS[name](words[1:])
    except workspace.DevError as error:
        if str(error):
            print("dev: %s" % error, file=sys.stderr)
        return error.status
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
