// SPDX-License-Identifier: Apache-2.0
// Progress of a command in a single line of the terminal.
#pragma once

#include <functional>

namespace navvy::cli {

/// Returns a function that shows progress on stderr in a single line; its argument is the completed
/// fraction, above 0 and up to 1. Returns an empty function if `quiet` is true or stderr is not a
/// terminal.
std::function<void(double)> progress_line(bool quiet);

}  // namespace navvy::cli
