// SPDX-License-Identifier: Apache-2.0
// Limits on files that are checked before a file is read: the size of the text, and names that can
// be used in results.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Returns the number of start tags in `text`, including those in comments.
std::size_t count_elements(const std::string& text);

/// Returns the position in `text` of the first tag with more attributes than core/limits.h allows;
/// npos if there is none. This must be checked before parsing, as the time of the parser is
/// quadratic in the number of attributes of one element.
std::size_t overloaded_tag(std::string_view text);

/// Returns the error for a file whose size `bytes` exceeds the limit of core/limits.h.
Fault too_large(const std::string& file, std::size_t bytes);

/// Checks that the text is UTF-8 and within the limits of bytes and elements. `file` is the name of
/// the file for messages. Returns false after an error, which reports the line.
bool check_text(const std::string& text, const std::string& file, Faults& faults);

/// Checks nesting, attributes, lists, names and texts of a parsed file. Returns false if a limit is
/// exceeded, in which case reading must stop. An invalid name or character is only reported.
bool check_tree(const Element& root, Faults& faults);

/// Checks a name that will become part of CSV headers, JSON and file names: no comma, quote,
/// control or invisible character, none of `= + - @` and no blank at its start, and a limited
/// length. Otherwise reports an error at the element `at` and returns false.
bool check_name(const Element& at, const std::string& name, Faults& faults);

}  // namespace navvy::scene_io
