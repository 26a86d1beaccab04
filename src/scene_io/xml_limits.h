// SPDX-License-Identifier: Apache-2.0
// What a file must hold before anything of it is read: text of a bounded size, and names that fit
// into results.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Elements that begin in `text`, those in comments too.
std::size_t count_elements(const std::string& text);

/// Where the first tag with more attributes than core/limits.h allows begins; npos: nowhere. Asked
/// before a text is parsed: the parser holds each attribute against all others of its element.
std::size_t overloaded_tag(std::string_view text);

/// What is wrong with a file of more bytes than core/limits.h allows, and what to do.
Fault too_large(const std::string& file, std::size_t bytes);

/// UTF-8, and no more bytes and elements than core/limits.h allows. False after a fault, which
/// names the line.
bool check_text(const std::string& text, const std::string& file, Faults& faults);

/// Nesting, attributes, lists, names and texts of a parsed file. False where there is too much of
/// something to read on; a bad name or character is a fault among others.
bool check_tree(const Element& root, Faults& faults);

/// A name goes into headers of CSV files, into JSON and into names of files: no control characters,
/// commas or quotes, and not without end. `at` is blamed. False after a fault.
bool check_name(const Element& at, const std::string& name, Faults& faults);

}  // namespace navvy::scene_io
