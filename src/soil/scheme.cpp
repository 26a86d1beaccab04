// SPDX-License-Identifier: Apache-2.0
#include "soil/scheme.h"

#include <cstdio>

#include "core/edit_distance.h"
#include "core/error.h"
#include "device/kernel_program.h"

namespace navvy::soil {
namespace {

/// A number in as few digits as a person needs: "0.05", "1e+06".
std::string short_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

InputError refused(const std::string& name, const std::string& value, const std::string& rule,
                   const std::string& remedy) {
  return InputError(Fault{Fault::Severity::kError, "", 0, "scheme." + name, value, rule, remedy});
}

}  // namespace

const std::vector<SchemeConstant>& scheme_constants() {
#define SCHEME_ROW(name, value, unit, low, high, help) \
  {#name, &SchemeConstants::name, unit, low, high, help},
  static const std::vector<SchemeConstant> rows = {SCHEME_CONSTANTS(SCHEME_ROW)};
#undef SCHEME_ROW
  return rows;
}

void set_scheme_constant(SchemeConstants& scheme, const std::string& name, double value) {
  std::vector<std::string> names;
  for (const SchemeConstant& row : scheme_constants()) {
    names.emplace_back(row.name);
    if (name != row.name) continue;
    // Written so that NaN is refused as well.
    if (!(value >= row.low && value <= row.high)) {
      const std::string unit = *row.unit == '\0' ? "" : " " + std::string(row.unit);
      throw refused(
          name, short_text(value),
          "must be within " + short_text(row.low) + " .. " + short_text(row.high) + unit,
          std::string(row.help) + "; the default is " + short_text(row.standard()) + unit);
    }
    scheme.*row.value = value;
    return;
  }
  throw refused(
      name, "", "is no constant of the scheme",
      "did you mean '" + nearest_name(names, name) + "'? `navvy lab constants` lists all of them");
}

std::vector<std::string> scheme_options(const SchemeConstants& scheme) {
  std::vector<std::string> out = {device::define("SCHEME_GIVEN", 1)};
  for (const SchemeConstant& row : scheme_constants())
    out.push_back(
        device::define(std::string("SCHEME_") + row.name, static_cast<float>(scheme.*row.value)));
  return out;
}

}  // namespace navvy::soil
