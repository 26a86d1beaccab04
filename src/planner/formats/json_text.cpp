// SPDX-License-Identifier: Apache-2.0
#include "planner/formats/json_text.h"

#include <cstdio>

namespace navvy::planner {

std::string json_string(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned>(c));
      out += code;
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string json_number(double value) {
  char text[40];
  if (value != value) return "null";
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

}  // namespace navvy::planner
