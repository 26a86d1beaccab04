// SPDX-License-Identifier: Apache-2.0
// Values as JSON text, for headers whose keys have an order.
#pragma once

#include <string>

namespace navvy::planner {

/// A string of JSON with its quotes. Bytes of UTF-8 stay as they are.
std::string json_string(const std::string& text);
/// With all the digits a double has; JSON knows no NaN: null.
std::string json_number(double value);

}  // namespace navvy::planner
