// SPDX-License-Identifier: Apache-2.0
// Constants of the particle scheme at run time: names, units, allowed ranges, and the build options
// that pass them to kernels.
#pragma once

#include <string>
#include <vector>

#include "soil/scheme_constants.h"

namespace navvy::soil {

/// Description of one scheme constant: one row of the table in kernels/soil/scheme_constants.h.
struct SchemeConstant {
  /// Name without the prefix "scheme.", for example "held_margin".
  const char* name;
  /// Member of SchemeConstants that holds the value.
  double SchemeConstants::*value;
  /// Unit of the value; an empty string for a dimensionless number.
  const char* unit;
  /// Lowest and highest allowed value; both are allowed themselves.
  double low, high;
  /// Description for listings: a noun phrase without a full stop.
  const char* help;

  /// Returns the default value.
  double standard() const { return kScheme.*value; }
};

/// Returns the descriptions of all scheme constants, in the order of the table in
/// kernels/soil/scheme_constants.h.
const std::vector<SchemeConstant>& scheme_constants();

/// Sets the constant `name` of `scheme` to `value`.
/// @throws InputError for an unknown name (the message suggests the most similar one) and for a
/// value outside the allowed range, NaN included.
void set_scheme_constant(SchemeConstants& scheme, const std::string& name, double value);

/// Returns the compiler options that define all constants for a kernel build. Kernels read them as
/// SCHEME(name).
std::vector<std::string> scheme_options(const SchemeConstants& scheme);

}  // namespace navvy::soil
