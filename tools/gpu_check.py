# SPDX-License-Identifier: Apache-2.0
"""`./dev gpu-check`: the kernels' schedule for GPUs, compiled offline for an NVIDIA GPU."""
import csv
import dataclasses
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import packages
import workspace
from workspace import ROOT, DevError, say

KERNELS = pathlib.Path("kernels")
LIBRARY = pathlib.Path("/usr/lib/clc/nvptx64--nvidiacl.bc")
ENVIRONMENT = pathlib.Path("build/gpu-check")
ASSEMBLER = "nvidia-cuda-nvcc-cu12"
ROWS = pathlib.Path("bench/results/gpu_check.csv")
# What a multiprocessor of compute capability 9.0 (H100) has, from NVIDIA's CUDA C++ Programming
# Guide, section "Compute Capabilities"; granularities from its occupancy calculator.
ARCHITECTURE = "sm_90"
REGISTERS, REGISTERS_AT_ONCE = 65536, 256
WARPS, WARPS_AT_ONCE, LANES = 64, 4, 32
GROUPS = 32
LOCAL_BYTES, LOCAL_AT_ONCE, LOCAL_RESERVED = 228 * 1024, 128, 1024
# The assembler spills a few words by itself where that lets another group in; more of them means
# that a kernel needs more registers than a work-item can have.
SPILLED_AT_MOST = 32
# Scatter keeps sums over local memory in registers beside the law's. On an H100 it took the same
# time with at most 64, 80 and 96 registers.
SPILLED = {"particle_to_grid": 160}
COLUMNS = (
    "kernel",
    "work-items of a group",
    "registers",
    "spilled bytes",
    "stack bytes",
    "local bytes",
    "groups at once",
    "occupancy",
    "limited by",
)


def spilled_at_most(kernel):
    """Returns the bytes that a kernel may spill."""
    return SPILLED.get(kernel.name.partition(",")[0], SPILLED_AT_MOST)


def rounded_up(value, unit):
    """Returns `value` rounded up to a multiple of `unit`."""
    return -(-value // unit) * unit


@dataclasses.dataclass
class Kernel:
    """One kernel as the assembler reports it."""

    name: str
    items: int = 0
    registers: int = 0
    spilled: int = 0
    stack: int = 0
    local: int = 0

    def limits(self):
        """Returns the groups that a multiprocessor can hold, by what limits them."""
        warps = -(-self.items // LANES)
        each = rounded_up(self.registers * LANES, REGISTERS_AT_ONCE)
        warps_by_registers = REGISTERS // each // WARPS_AT_ONCE * WARPS_AT_ONCE
        local = rounded_up(self.local + LOCAL_RESERVED, LOCAL_AT_ONCE)
        return {
            "warps": WARPS // warps,
            "registers": warps_by_registers // warps,
            "local memory": LOCAL_BYTES // local,
            "groups": GROUPS,
        }

    def row(self):
        """Returns the kernel's row of the table."""
        limits = self.limits()
        groups = min(limits.values())
        warps = groups * -(-self.items // LANES)
        return (
            "`%s`" % self.name,
            self.items,
            self.registers,
            self.spilled,
            self.stack,
            self.local,
            groups,
            "%.0f %%" % (100 * warps / WARPS),
            next(name for name, most in limits.items() if most == groups),
        )


def group_sizes(code):
    """Returns the work-items of a group of each kernel by its name, from LLVM code."""
    nodes = dict(re.findall(r"^(!\d+) = !\{(i32 [^}]*)\}$", code, re.M))
    kernels = re.findall(r"^define .*@(\w+)\(.* !reqd_work_group_size (!\d+)", code, re.M)
    return {
        name: math.prod(int(size) for size in re.findall(r"i32 (\d+)", nodes[node]))
        for name, node in kernels
    }


def with_group_sizes(ptx, sizes):
    """Returns PTX that states the groups' sizes, which clang leaves out: the assembler then knows
    how many registers a work-item may have, as a driver's compiler does.
    """
    for name, size in sizes.items():
        ptx = re.sub(
            r"(\.entry %s\([^)]*\))" % name, r"\1\n.reqntid %d, 1, 1" % size, ptx, count=1
        )
    return ptx


def kernels_of(report, sizes):
    """Returns the kernels that the assembler's report lists; `sizes` are those of their groups."""
    out = []
    for part in report.split("Compiling entry function ")[1:]:

        def number(pattern, text=part):
            found = re.search(pattern, text)
            return int(found[1]) if found else 0

        name = re.match(r"'(\w+)'", part)[1]
        out.append(
            Kernel(
                name,
                sizes[name],
                number(r"Used (\d+) registers"),
                number(r"(\d+) bytes spill stores") + number(r"(\d+) bytes spill loads"),
                number(r"(\d+) bytes stack frame"),
                number(r"(\d+) bytes smem"),
            )
        )
    return out


def found_assembler():
    """Returns the path of ptxas on this machine; None where there is none."""
    for folder in ROOT.glob(str(ENVIRONMENT / "lib/*/site-packages/nvidia/cuda_nvcc/bin")):
        if (folder / "ptxas").is_file():
            return folder / "ptxas"
    return shutil.which("ptxas")


def missing_tools():
    """Returns which of the tools are missing, one text each with its remedy."""
    out = []
    if shutil.which("clang") is None or not LIBRARY.is_file():
        out.append("clang and libclc: apt-get install " + " ".join(packages.GPU_CHECK))
    if found_assembler() is None:
        out.append("ptxas: it is in %s on PyPI and in NVIDIA's CUDA toolkit" % ASSEMBLER)
    return out


def install_tools():
    """Installs the tools that are missing: Debian packages, the assembler into build/gpu-check."""
    packages.install(packages.GPU_CHECK, packages.READERS)
    if found_assembler() is None and packages.enabled:
        say("installing %s from PyPI into %s" % (ASSEMBLER, ENVIRONMENT))
        workspace.run(sys.executable, "-m", "venv", ENVIRONMENT)
        # Soon given up: what is missing after that is reported.
        pip = [ENVIRONMENT / "bin/pip", "-q", "--timeout", "15", "--retries", "1", "install"]
        workspace.run(*pip, "--no-deps", ASSEMBLER, check=False)


def checked(command, subject):
    """Runs a compiler and returns all its output; raises DevError when it fails."""
    done = subprocess.run(
        [str(word) for word in command],
        cwd=ROOT,
        text=True,
        check=False,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    if done.returncode != 0:
        raise DevError("gpu-check: %s does not compile:\n%s" % (subject, done.stdout))
    return done.stdout


def compiled(source, options, scratch):
    """Compiles one kernel file to PTX and then for ARCHITECTURE; returns its kernels."""
    ptx, code = (pathlib.Path(scratch) / name for name in ("kernels.ptx", "kernels.ll"))
    # As src/device/kernel_program.cpp asks a driver to compile. clang 14 knows GPUs up to sm_86;
    # the assembler takes their PTX for later ones.
    front = ["-target", "nvptx64--nvidiacl", "-x", "cl", "-cl-std=CL1.2", "-O3", "-I", KERNELS]
    front += ["-cl-fp32-correctly-rounded-divide-sqrt", *options, "-S"]
    for word in ("-finclude-default-header", "-target-cpu", "sm_80", "-target-feature", "+ptx70"):
        front += ["-Xclang", word]
    bitcode = ["-Xclang", "-mlink-builtin-bitcode", "-Xclang", LIBRARY]
    raw = ["-Xclang", "-disable-llvm-passes", "-emit-llvm"]
    checked(["clang", *front, *raw, "-o", code, source], source)
    sizes = group_sizes(code.read_text(encoding="utf-8"))
    checked(["clang", *front, *bitcode, "-o", ptx, source], source)
    ptx.write_text(with_group_sizes(ptx.read_text(encoding="utf-8"), sizes), encoding="utf-8")
    assemble = [found_assembler(), "-v", "-arch=" + ARCHITECTURE, ptx, "-o", "/dev/null"]
    return kernels_of(checked(assemble, source), sizes)


def all_kernels():
    """Compiles every file of kernels/soil/groups; returns their kernels by name."""
    out = []
    with tempfile.TemporaryDirectory() as scratch:
        for source in sorted(path.relative_to(ROOT) for path in ROOT.glob("kernels/*/groups/*.cl")):
            out += compiled(source, [], scratch)
            # The host builds it a second way, for soils that use the whole law.
            if source.stem == "particle_to_grid":
                extended = compiled(source, ["-DLAW_EXTENDED=1"], scratch)
                out += [
                    dataclasses.replace(k, name=k.name + ", extended law") for k in extended
                ]
    return sorted(out, key=lambda kernel: kernel.name)


def print_table(rows):
    """Prints rows below the names of their columns."""
    table = [COLUMNS, *([str(cell).strip("`") for cell in row] for row in rows)]
    widths = [max(len(row[column]) for row in table) for column in range(len(COLUMNS))]
    for row in table:
        print("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip())


def gpu_check_command(arguments):
    """Compiles the kernels' schedule for GPUs offline; prints registers, spills and occupancy.

    Uses clang, libclc and ptxas for compute capability 9.0; no GPU and no driver is needed. Fails
    when a kernel does not compile, when it spills more than a few registers, or when a
    multiprocessor cannot hold a group. Occupancy is the share of a multiprocessor's warps that
    can be resident.
    """
    parser = workspace.parser(gpu_check_command, "gpu-check [--write] [--skip-without-tools]")
    parser.add_argument("--write", action="store_true", help="write the rows to %s" % ROWS)
    parser.add_argument(
        "--skip-without-tools",
        action="store_true",
        help="succeed with a note where a tool is missing and cannot be installed",
    )
    options = parser.parse_args(arguments)
    install_tools()
    missing = missing_tools()
    if missing:
        text = "gpu-check: missing " + "; ".join(missing)
        if not options.skip_without_tools:
            raise DevError(text)
        say("SKIPPED " + text)
        return
    kernels = all_kernels()
    rows = [kernel.row() for kernel in kernels]
    print_table(rows)
    if options.write:
        with open(ROOT / ROWS, "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(COLUMNS)
            writer.writerows(rows)
        say("rows are in %s; `./dev docs` renews the table of bench/README.md" % ROWS)
    faults = [
        "%s spills %d bytes, more than %d" % (kernel.name, kernel.spilled, spilled_at_most(kernel))
        for kernel in kernels
        if kernel.spilled > spilled_at_most(kernel)
    ]
    faults += [
        "no group of %s fits (%s)" % (kernel.name, row[-1])
        for kernel, row in zip(kernels, rows)
        if row[6] == 0
    ]
    if faults:
        raise DevError("gpu-check: " + "; ".join(faults))
    say("gpu-check: %d kernels compile for %s" % (len(kernels), ARCHITECTURE))
