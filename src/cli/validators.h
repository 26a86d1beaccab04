// SPDX-License-Identifier: Apache-2.0
// Checks of single values on the command line with clear messages.
#pragma once

#include <string>

namespace navvy::cli {

/// Checks for a finite number above 0. Returns an empty text or an error message, for
/// CLI::Option::check. (The check of CLI11 prints its bounds with 300 digits.)
std::string above_zero(const std::string& text);
/// Checks for a finite number of at least 0.
std::string not_negative(const std::string& text);
/// Checks for a whole number from 0 to 2^64 - 1.
std::string whole_number(const std::string& text);

}  // namespace navvy::cli
