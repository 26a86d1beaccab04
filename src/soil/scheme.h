// SPDX-License-Identifier: Apache-2.0
// Constants of the particle scheme at run time: names, units, ranges, and build options of kernels.
#pragma once

#include <string>
#include <vector>

#include "soil/scheme_constants.h"

namespace navvy::soil {

/// One row of kernels/soil/scheme_constants.h.
struct SchemeConstant {
  /// Name in the table, without the prefix "scheme.".
  const char* name;
  /// Member that holds the value.
  double SchemeConstants::*value;
  /// "" for a pure number.
  const char* unit;
  /// Both allowed.
  double low, high;
  /// Noun phrase without a full stop.
  const char* help;

  /// Returns the default value.
  double standard() const { return kScheme.*value; }
};

/// Returns all rows, in the order of the table.
const std::vector<SchemeConstant>& scheme_constants();

/// Sets one constant by its name.
/// @throws InputError naming the nearest constant for an unknown name, or the range for a value
/// outside it (NaN included).
void set_scheme_constant(SchemeConstants& scheme, const std::string& name, double value);

/// Returns the build options that hand all constants to a kernel, as SCHEME(name) reads them.
std::vector<std::string> scheme_options(const SchemeConstants& scheme);

}  // namespace navvy::soil
