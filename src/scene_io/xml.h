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

/// Amount of work that reading a scene has taken so far. The limits in core/limits.h apply to the
/// scene with all its files.
struct Work {
  std::size_t files = 0;  ///< XML files opened
  /// Size of these files [bytes].
  std::size_t bytes = 0;
  /// Number of XML elements; those of a machine's file count each time the file is included.
  std::size_t elements = 0;
  std::size_t models = 0;  ///< models read through libsdformat
  /// Result of reading one OBJ file.
  struct Mesh {
    std::size_t vertices = 0;
    /// Reason why the file cannot be read; empty if it can.
    std::string fault;
  };
  /// OBJ files by path. Each file is read once.
  std::map<std::string, Mesh> meshes;
  /// Size of all OBJ files [bytes].
  std::uintmax_t mesh_bytes = 0;
};

/// List of all errors and warnings found in a scene and the files it names. Readers continue after
/// an error, so that a user can correct all errors at once. The list contains at most
/// limits::kFaultsShown errors and as many warnings; one more entry counts the rest. Elements that
/// come from command-line settings (line 0) are reported with the file name "command line".
class Faults {
 public:
  /// Adds an error. The element `at` gives file, line and path; `value` is the invalid value,
  /// `rule` states what is allowed, and `remedy` how to correct it.
  void error(const Element& at, const std::string& value, const std::string& rule,
             const std::string& remedy = "");
  /// Adds a warning; the parameters are those of `error`.
  void warning(const Element& at, const std::string& value, const std::string& rule,
               const std::string& remedy = "");
  /// Returns a suggestion for the misspelt `word` (see core/edit_distance.h). A list of all
  /// candidates is returned only once. Returns an empty text if no more errors will be shown, since
  /// the search is slow.
  std::string nearest(const std::string& word, const std::vector<std::string>& candidates) const;
  void add(Fault fault);
  /// Returns true if an error was reported at `element` or at an element inside it. Rules that
  /// combine several fields skip such elements.
  bool has_fault(const Element& element) const { return faulty_.count(&element) > 0; }
  bool has_errors() const { return error_count() > 0; }
  /// Returns the number of all errors, including those that the list leaves out.
  std::size_t error_count() const { return errors_.all; }
  std::size_t warning_count() const { return warnings_.all; }
  const std::vector<Fault>& list() const { return list_; }
  /// Logs the warnings. @throws InputError with the whole list if there is an error.
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

/// File and line where an element was written.
struct Place {
  /// Path of the file; null for an element from the command line.
  const std::string* file = nullptr;
  int line = 0;
};
Place place_of(const Element& element);

/// One parsed XML file. Elements point to their document, so it is created on the heap and never
/// moves. Elements are valid as long as their document exists.
class Document {
 public:
  /// Reads and parses a file. Old names of elements and values are replaced by the current ones.
  /// Returns null after an error (file missing or unreadable, no valid XML).
  static std::unique_ptr<Document> open(const std::string& file, Faults& faults);
  static std::unique_ptr<Document> parse(const std::string& text, const std::string& name,
                                         Faults& faults);
  /// Returns the document that `element` belongs to.
  static const Document& of(const Element& element);

  const std::string& file() const { return file_; }
  /// Returns a new element of this document, not yet inserted. Messages report it at the file and
  /// line of `from`, which may belong to another document.
  Element* create(const char* name, const Element& from);
  std::string directory() const;
  Element* root() { return xml_.RootElement(); }
  std::size_t elements() const { return elements_; }
  /// Returns the current XML text, including comments.
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

/// Returns the element's path for messages, e.g. "world/navvy:soil[loam]/cohesion_pa". Brackets
/// contain the element's name or, among siblings without names, its position counted from 1.
std::string element_path(const Element& element);
/// Returns the first child element of type `kind` whose attribute `name` equals the parameter; null
/// if there is none.
const Element* named_child(const Element& parent, const char* kind, const std::string& name);
/// Returns the text directly inside the element, without leading and trailing blanks.
std::string text_of(const Element& element);
/// Returns the text of the child element `name`, without leading and trailing blanks; empty if
/// there is no such child.
std::string child_text(const Element& element, const char* name);
/// Returns the value of the attribute `name`; empty if there is no such attribute.
std::string attribute(const Element& element, const char* name);
/// Returns true if the element is in the namespace `navvy:`, false if it belongs to standard SDF.
bool is_extension(const Element& element);

/// Splits a text at white space.
std::vector<std::string> words_of(const std::string& text);
/// Converts the whole `text` to a number, independent of the locale. Accepts nan and inf. Returns
/// false if the text is not a number.
bool to_number(const std::string& text, double& value);

}  // namespace navvy::scene_io
