// SPDX-License-Identifier: Apache-2.0
// Errors for machines that this engine cannot build.
#pragma once

#include <string>

#include "core/error.h"

namespace navvy::vehicle {

/// Throws InputError with the element of the machine ("wheel", "link[name]"), the offending value
/// (may be empty) and the rule it breaks.
/// @throws InputError always.
[[noreturn]] inline void refuse(const std::string& element, const std::string& value,
                                const std::string& rule) {
  Fault fault;
  fault.element = element;
  fault.value = value;
  fault.rule = rule;
  throw InputError(fault);
}

}  // namespace navvy::vehicle
