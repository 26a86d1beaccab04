// SPDX-License-Identifier: Apache-2.0
// Source and build tree of a test. Functions instead of macros of the command line: objects stay
// the same in every checkout, so that a compiler cache serves them all.
#pragma once

#include <string>

namespace navvy {

/// Absolute path of the source tree, without a slash at its end.
std::string source_dir();
/// Absolute path of the build tree; a test writes below "<build>/test-<its own name>".
std::string build_dir();

}  // namespace navvy
