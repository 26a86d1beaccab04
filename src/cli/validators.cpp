// SPDX-License-Identifier: Apache-2.0
#include "cli/validators.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>

namespace navvy::cli {
namespace {

/// Returns the number in a text; NaN if the text is no finite number.
double number(const std::string& text) {
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  return code == std::errc() && end == text.data() + text.size() && std::isfinite(value) ? value
                                                                                         : NAN;
}

}  // namespace

// Comparisons with NaN are false.
std::string above_zero(const std::string& text) {
  return number(text) > 0 ? "" : "'" + text + "': must be a number above 0";
}

std::string not_negative(const std::string& text) {
  return number(text) >= 0 ? "" : "'" + text + "': must be a number, 0 or above";
}

std::function<std::string(const std::string&)> within(double least, double most) {
  return [least, most](const std::string& text) {
    const double value = number(text);
    if (value >= least && value <= most) return std::string();
    char range[80];
    std::snprintf(range, sizeof range, "': must be a number from %g to %g", least, most);
    return "'" + text + range;
  };
}

// Seeds use all 64 bits, which a double does not hold.
std::string whole_number(const std::string& text) {
  std::uint64_t value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool ok = code == std::errc() && end == text.data() + text.size();
  return ok ? "" : "'" + text + "': must be a whole number from 0 to 18446744073709551615";
}

}  // namespace navvy::cli
