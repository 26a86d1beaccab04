// SPDX-License-Identifier: Apache-2.0
// Validates single values of command line options, with clear error messages.
#pragma once

#include <functional>
#include <string>

namespace navvy::cli {

/// Checks that `text` is a finite number greater than 0. Returns an error message, or an empty text
/// if it is, as CLI::Option::check requires. (The check of CLI11 itself prints its bounds with 300
/// digits.)
std::string above_zero(const std::string& text);
/// Checks that `text` is a finite number greater than or equal to 0. Returns an error message, or
/// an empty text if it is.
std::string not_negative(const std::string& text);
/// Returns a check that a text is a finite number from `least` to `most`; like those above, it
/// returns an error message or an empty text. (The check of CLI11 itself accepts NaN.)
std::function<std::string(const std::string&)> within(double least, double most);
/// Checks that `text` is an integer from 0 to 2^64 - 1. Returns an error message, or an empty text
/// if it is.
std::string whole_number(const std::string& text);

}  // namespace navvy::cli
