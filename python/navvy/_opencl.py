# SPDX-License-Identifier: Apache-2.0
"""Finds the OpenCL driver for processors that PyPI offers."""
from __future__ import annotations

import glob
import os
import site
import sysconfig

# Variables by which users choose drivers themselves.
_CHOICES = ("OCL_ICD_VENDORS", "OCL_ICD_FILENAMES", "OPENCL_VENDOR_PATH")
_SYSTEM = "/etc/OpenCL/vendors/*.icd"


def find_driver() -> None:
    """Lets the OpenCL loader find the package intel-opencl-rt, which installs a CPU device without
    root, where the system has no driver of its own. Call it before the loader starts.
    """
    if any(os.environ.get(name) for name in _CHOICES) or glob.glob(_SYSTEM):
        return
    for folder in (sysconfig.get_path("data"), site.USER_BASE):
        file = os.path.join(folder or "", "lib", "libintelocl.so")
        if folder and os.path.isfile(file):
            os.environ["OCL_ICD_VENDORS"] = file
            return
