// SPDX-License-Identifier: Apache-2.0
// Checks of single values on the command line that CLI11 has no good words for.
#pragma once

#include <string>

namespace navvy::cli {

/// Empty for a finite number above zero, else what is wrong with it: for CLI::Option::check.
/// (CLI11's own check prints its bounds with 300 digits.)
std::string above_zero(const std::string& text);
/// The same for a finite number of at least 0.
std::string not_negative(const std::string& text);
/// The same for a whole number from 0 to 2^64 - 1.
std::string whole_number(const std::string& text);

}  // namespace navvy::cli
