// SPDX-License-Identifier: Apache-2.0
// Parsed files that know their name and line numbers, and the list of faults found in them.
#pragma once

#include <tinyxml2.h>

#include <memory>
#include <string>
#include <vector>

#include "core/edit_distance.h"
#include "core/error.h"

namespace navvy::scene_io {

using Element = tinyxml2::XMLElement;

/// Collects faults; an element added by an override (line 0) is reported as coming from the command line. Readers go on
/// after a fault, so one list holds all of a scene and of the files it names.
class Faults {
 public:
  /// `at` gives file, line and path; `value` is what was found, `rule` what is allowed, `remedy` what to do.
  void error(const Element& at, const std::string& value, const std::string& rule, const std::string& remedy = "");
  void warning(const Element& at, const std::string& value, const std::string& rule, const std::string& remedy = "");
  void add(Fault fault) { list_.push_back(std::move(fault)); }
  bool has_errors() const { return error_count() > 0; }
  std::size_t error_count() const;
  const std::vector<Fault>& list() const { return list_; }
  /// Throws InputError with the whole list if it holds an error; else logs the warnings.
  void finish() const;

 private:
  void add_at(Fault::Severity severity, const Element& at, const std::string& value, const std::string& rule,
              const std::string& remedy);
  std::vector<Fault> list_;
};

/// One XML file. Its elements live as long as it does. It is made on the heap and stays where it is, as its elements
/// lead back to it.
class Document {
 public:
  /// Null after a fault (missing, unreadable, not XML).
  static std::unique_ptr<Document> open(const std::string& file, Faults& faults);
  static std::unique_ptr<Document> parse(const std::string& text, const std::string& name, Faults& faults);
  /// The document an element belongs to.
  static const Document& of(const Element& element);

  const std::string& file() const { return file_; }
  std::string directory() const;
  Element* root() { return xml_.RootElement(); }
  /// The file's text as it is now, comments included.
  std::string text() const;

 private:
  Document() = default;
  tinyxml2::XMLDocument xml_;
  std::string file_;
};

/// "world/navvy:soil[loam]/cohesion_pa": names in brackets, or the 1-based place among equal siblings.
std::string element_path(const Element& element);
/// All text directly inside the element, trimmed.
std::string text_of(const Element& element);
/// Text of a child element, trimmed; empty when there is none.
std::string child_text(const Element& element, const char* name);
/// Value of an attribute; empty when there is none.
std::string attribute(const Element& element, const char* name);
/// An element of Navvy's own, in the namespace `navvy:`; the rest is SDF.
bool is_extension(const Element& element);

/// Whitespace-separated words.
std::vector<std::string> words_of(const std::string& text);
/// The whole of `text` as a number, whatever the locale. False: not a number (nan and inf are numbers here).
bool to_number(const std::string& text, double& value);

}  // namespace navvy::scene_io
