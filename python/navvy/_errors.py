# SPDX-License-Identifier: Apache-2.0
"""Exceptions of Navvy."""
from __future__ import annotations

from typing import NamedTuple


class Fault(NamedTuple):
    """One error or warning about a file or another input; texts that do not apply are empty."""

    severity: str
    file: str
    line: int
    element: str
    value: str
    rule: str
    remedy: str


class Error(Exception):
    """Base class of all exceptions of Navvy; its text says what is wrong and what to do."""


class InputError(Error, ValueError):
    """An invalid scene, name, value or snapshot; `faults` lists all that was found."""

    def __init__(self, text: str, faults: tuple[Fault, ...] = ()) -> None:
        super().__init__(text)
        self.faults = tuple(faults)

    def __reduce__(self):
        return type(self), (str(self), self.faults)


class FileError(Error, OSError):
    """A file that cannot be read or written."""


class DeviceError(Error):
    """OpenCL is missing or failed, or was used after fork()."""


class SimulationError(Error):
    """A step failed; the world keeps its last state until `reset` or `load`."""


class BusyError(Error):
    """Another thread is inside the same world."""


class ClosedError(Error):
    """The world was closed."""
