// SPDX-License-Identifier: Apache-2.0
// Limits of a file that are checked before it is read: size of the text, and names that fit into
// results.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Returns the number of elements that begin in `text`, those in comments included.
std::size_t count_elements(const std::string& text);

/// Returns the position of the first tag with more attributes than core/limits.h allows; npos if
/// there is none. It is checked before parsing, as the parser compares each attribute with all
/// others of its element.
std::size_t overloaded_tag(std::string_view text);

/// Returns the fault of a file with more bytes than core/limits.h allows.
Fault too_large(const std::string& file, std::size_t bytes);

/// Checks that the text is UTF-8 and within the limits of bytes and elements. Returns false after a
/// fault, which names the line.
bool check_text(const std::string& text, const std::string& file, Faults& faults);

/// Checks nesting, attributes, lists, names and texts of a parsed file. Returns false if a limit is
/// exceeded, so that reading must stop. A bad name or character is an ordinary fault.
bool check_tree(const Element& root, Faults& faults);

/// Checks a name, which becomes part of CSV headers, JSON and file names: no control characters,
/// commas or quotes, and a limited length. Reports a fault at `at` and returns false.
bool check_name(const Element& at, const std::string& name, Faults& faults);

}  // namespace navvy::scene_io
