// SPDX-License-Identifier: Apache-2.0
// Errors for machines that the Bullet engine cannot build.
#pragma once

#include <string>

#include "core/error.h"

namespace navvy::vehicle {

/// Throws an InputError about one element of a machine.
/// @param element the element, such as "wheel" or "link[name]"
/// @param value the offending value; may be empty
/// @param rule the rule that the value breaks
/// @throws InputError always
[[noreturn]] inline void refuse(const std::string& element, const std::string& value,
                                const std::string& rule) {
  Fault fault;
  fault.element = element;
  fault.value = value;
  fault.rule = rule;
  throw InputError(fault);
}

}  // namespace navvy::vehicle
