// SPDX-License-Identifier: Apache-2.0
// Where a test finds the tree it was built from, and where it may write. Functions, not macros of
// the command line: objects stay the same in every checkout, so a compiler cache serves them all.
#pragma once

#include <string>

namespace navvy {

/// Absolute path of the source tree, without a slash at its end.
std::string source_dir();
/// Absolute path of the build tree; a test writes below "<build>/test-<its own name>".
std::string build_dir();

}  // namespace navvy
