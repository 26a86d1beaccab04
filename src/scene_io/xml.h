// SPDX-License-Identifier: Apache-2.0
// Parsed files that know their name and line numbers, and the list of faults found in them.
#pragma once

#include <tinyxml2.h>

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/edit_distance.h"
#include "core/error.h"

namespace navvy::scene_io {

using Element = tinyxml2::XMLElement;

/// Work done by reading so far. The limits of core/limits.h count it for a scene as a whole.
struct Work {
  std::size_t files = 0;     ///< XML files opened
  std::size_t bytes = 0;     ///< of them
  std::size_t elements = 0;  ///< of them, an included machine's at each use
  std::size_t models = 0;    ///< models read through libsdformat
  /// An OBJ file that shapes name.
  struct Mesh {
    std::size_t vertices = 0;
    std::string fault;  ///< why it cannot be read
  };
  std::map<std::string, Mesh> meshes;  ///< by path, each read once
  std::uintmax_t mesh_bytes = 0;       ///< of them
};

/// List of the faults of a scene and of all files it names. Readers go on after a fault. Beyond
/// limits::kFaultsShown of a severity, the list holds the number of the others. An element that an
/// override has added (line 0) is reported as from the command line.
class Faults {
 public:
  /// Reports an error. `at` gives file, line and path; `value` was found, `rule` is allowed,
  /// `remedy` says how to correct it.
  void error(const Element& at, const std::string& value, const std::string& rule,
             const std::string& remedy = "");
  void warning(const Element& at, const std::string& value, const std::string& rule,
               const std::string& remedy = "");
  /// Returns the `suggestion` of core/edit_distance.h; a list of all candidates only once. Returns
  /// an empty text if the fault would not be shown, as the search is slow.
  std::string nearest(const std::string& word, const std::vector<std::string>& candidates) const;
  void add(Fault fault);
  /// Returns true if an error was reported at `element` or inside it. Rules among several fields
  /// skip elements with faults of their own.
  bool has_fault(const Element& element) const { return faulty_.count(&element) > 0; }
  bool has_errors() const { return error_count() > 0; }
  /// Returns the number of all faults, shown or not.
  std::size_t error_count() const { return errors_.all; }
  std::size_t warning_count() const { return warnings_.all; }
  const std::vector<Fault>& list() const { return list_; }
  /// Logs the warnings. @throws InputError with the whole list if it holds an error.
  void finish() const;

  Work work;

 private:
  /// Number of faults of one severity, and the entry that counts those not shown.
  struct Counted {
    std::size_t all = 0, rest_at = 0;
  };
  Counted& counted(Fault::Severity severity) {
    return severity == Fault::Severity::kError ? errors_ : warnings_;
  }
  /// Counts one more fault; returns false if it must not be shown.
  bool count(Fault::Severity severity);
  void add_at(Fault::Severity severity, const Element& at, const std::string& value,
              const std::string& rule, const std::string& remedy);
  std::vector<Fault> list_;
  Counted errors_, warnings_;
  mutable std::set<std::string> listed_;
  std::set<const void*> faulty_;  ///< elements with errors, and all around them
};

/// Place where an element was written.
struct Place {
  const std::string* file = nullptr;  ///< null: on the command line
  int line = 0;
};
Place place_of(const Element& element);

/// One XML file, which its elements refer to: it is created on the heap and never moves. Elements
/// live as long as their document.
class Document {
 public:
  /// Reads a file; returns null after a fault (missing, unreadable, not XML). Old names of elements
  /// and values are replaced by current ones.
  static std::unique_ptr<Document> open(const std::string& file, Faults& faults);
  static std::unique_ptr<Document> parse(const std::string& text, const std::string& name,
                                         Faults& faults);
  /// Returns the document of an element.
  static const Document& of(const Element& element);

  const std::string& file() const { return file_; }
  /// Returns a new element of this document that is reported at the place of `from`, which may be
  /// of any document.
  Element* create(const char* name, const Element& from);
  std::string directory() const;
  Element* root() { return xml_.RootElement(); }
  std::size_t elements() const { return elements_; }
  /// Returns the present text, comments included.
  std::string text() const;

 private:
  Document() = default;
  static void rename_old(Element& element, int depth = 0);
  tinyxml2::XMLDocument xml_;
  std::string file_;
  std::set<std::string> other_files_;
  std::deque<Place> places_;  ///< of elements that were created: they lead here
  std::size_t elements_ = 0;
};

/// Returns a path such as "world/navvy:soil[loam]/cohesion_pa": with names in brackets, or the
/// 1-based place among equal siblings.
std::string element_path(const Element& element);
/// Returns the first child <kind> with this attribute `name`; null if there is none.
const Element* named_child(const Element& parent, const char* kind, const std::string& name);
/// Returns all text directly inside the element, trimmed.
std::string text_of(const Element& element);
/// Returns the trimmed text of a child; empty if there is none.
std::string child_text(const Element& element, const char* name);
/// Returns the value of an attribute; empty if there is none.
std::string attribute(const Element& element, const char* name);
/// Returns true for an element in the namespace `navvy:`; others belong to SDF.
bool is_extension(const Element& element);

/// Splits a text into words.
std::vector<std::string> words_of(const std::string& text);
/// Reads the whole text as a number, in any locale; NaN and infinity are numbers. Returns false if
/// it is none.
bool to_number(const std::string& text, double& value);

}  // namespace navvy::scene_io
