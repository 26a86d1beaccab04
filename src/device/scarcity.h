// SPDX-License-Identifier: Apache-2.0
// Limits of the process that keep an OpenCL driver from starting.
#pragma once

#include <string>

namespace navvy::device {

/// Returns which limit of this process is too low for a driver that is installed, as a sentence
/// with a remedy: open files (ulimit -n) or memory (ulimit -v). Empty if no driver is installed or
/// no limit explains that it offers no device. Opens and closes some files.
std::string scarcity();

}  // namespace navvy::device
