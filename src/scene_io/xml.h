// SPDX-License-Identifier: Apache-2.0
// Parsed XML files with file names and line numbers, and the list of errors and warnings found in
// them.
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

/// An XML element; see tinyxml2 for its functions.
using Element = tinyxml2::XMLElement;

/// Amount of reading done so far for one scene, compared with the limits of core/limits.h.
struct Work {
  std::size_t files = 0;  ///< number of XML files opened
  std::size_t bytes = 0;  ///< total size of the opened XML files [bytes]
  /// Number of XML elements; those of an included machine count at each use.
  std::size_t elements = 0;
  std::size_t models = 0;  ///< number of models read through libsdformat
  /// Result of reading an OBJ file.
  struct Mesh {
    std::size_t vertices = 0;  ///< number of vertices
    std::string fault;         ///< reason why the file cannot be read; empty if it can
  };
  std::map<std::string, Mesh> meshes;  ///< OBJ files, keyed by path; each is read once
  std::uintmax_t mesh_bytes = 0;       ///< total size of the OBJ files [bytes]
};

/// List of the errors and warnings of a scene and all files that it names. Readers continue after
/// an error. Of each severity, the list shows at most limits::kFaultsShown entries, followed by one
/// entry with the number of the remaining ones. An element that an override has added (line 0) is
/// reported with "command line" as its file.
class Faults {
 public:
  /// Reports an error at the element `at`, which provides file, line and path. `value` is the
  /// invalid text, `rule` what is allowed, and `remedy` how to correct it.
  void error(const Element& at, const std::string& value, const std::string& rule,
             const std::string& remedy = "");
  /// Reports a warning at the element `at`. `value` is the text concerned, `rule` says what is
  /// wrong, and `remedy` how to correct it.
  void warning(const Element& at, const std::string& value, const std::string& rule,
               const std::string& remedy = "");
  /// Returns the `suggestion` of core/edit_distance.h for `word`. A list of all candidates is
  /// returned only the first time. Returns an empty text if further errors are not shown anyway, as
  /// the search is slow.
  std::string nearest(const std::string& word, const std::vector<std::string>& candidates) const;
  /// Adds a complete error or warning, for example one that has no element.
  void add(Fault fault);
  /// Returns true if an error was reported at `element` or inside it. Rules that concern several
  /// fields skip such elements.
  bool has_fault(const Element& element) const { return faulty_.count(&element) > 0; }
  /// Returns true if there is at least one error.
  bool has_errors() const { return error_count() > 0; }
  /// Returns the total number of errors, including those that are not listed.
  std::size_t error_count() const { return errors_.all; }
  /// Returns the total number of warnings, including those that are not listed.
  std::size_t warning_count() const { return warnings_.all; }
  /// Returns the listed errors and warnings in the order in which they were reported.
  const std::vector<Fault>& list() const { return list_; }
  /// Logs the warnings if there are no errors. @throws InputError with the whole list if it
  /// contains an error.
  void finish() const;

  Work work;  ///< amount of reading done so far

 private:
  /// Total number of faults of one severity, and the index in `list_` of the entry that counts
  /// those not shown.
  struct Counted {
    std::size_t all = 0, rest_at = 0;
  };
  /// Returns the counts of a severity.
  Counted& counted(Fault::Severity severity) {
    return severity == Fault::Severity::kError ? errors_ : warnings_;
  }
  /// Counts one fault of this severity; returns false if the fault must not be added to the list.
  bool count(Fault::Severity severity);
  /// Adds a fault at an element; implements `error` and `warning`.
  void add_at(Fault::Severity severity, const Element& at, const std::string& value,
              const std::string& rule, const std::string& remedy);
  std::vector<Fault> list_;    ///< listed faults
  Counted errors_, warnings_;  ///< counts of each severity
  /// Lists of candidates that `nearest` has already returned.
  mutable std::set<std::string> listed_;
  /// Elements in which an error was reported, and all their ancestors.
  std::set<const void*> faulty_;
};

/// Position in a file at which an element was written.
struct Place {
  const std::string* file = nullptr;  ///< name of the file; null: the command line
  int line = 0;                       ///< line number, starting from 1; 0: the command line
};
/// Returns the position at which an element was written.
Place place_of(const Element& element);

/// One parsed XML file. Documents are created on the heap and never move, as their elements hold
/// pointers to them. Elements live as long as their document.
class Document {
 public:
  /// Reads and parses a file; returns null after an error (missing, unreadable, not XML). Old names
  /// of elements and values are replaced by the current ones, and files of other simulators are
  /// rewritten (scene_io/foreign.h).
  static std::unique_ptr<Document> open(const std::string& file, Faults& faults);
  /// Parses the text of a file like `open`; `name` is used as its file name.
  static std::unique_ptr<Document> parse(const std::string& text, const std::string& name,
                                         Faults& faults);
  /// Returns the document that contains an element.
  static const Document& of(const Element& element);

  /// Appends a copy of `from`, with everything inside, to the children of `parent`, which belongs
  /// to any document. Errors in the copy are reported at the position of its original.
  static void append_copy(Element& parent, const Element& from);

  /// Returns the name of the file.
  const std::string& file() const { return file_; }
  /// Creates an element in this document; the caller inserts it. Errors in the new element are
  /// reported at the position of `from`, which may belong to another document.
  Element* create(const char* name, const Element& from);
  /// Returns the directory of the file; "." if the name contains none.
  std::string directory() const;
  /// Returns the root element.
  Element* root() { return xml_.RootElement(); }
  /// Returns true if the file was written for another simulator; see scene_io/foreign.h.
  bool foreign() const { return foreign_; }
  /// Marks the file as written for another simulator.
  void mark_foreign() { foreign_ = true; }
  /// Replaces the root element, which is deleted, by `root`, an element of this document.
  void replace_root(Element& root);
  /// Returns the number of XML elements that the document had when it was parsed.
  std::size_t elements() const { return elements_; }
  /// Returns the document as text in its current state, including comments.
  std::string text() const;

 private:
  Document() = default;
  /// Replaces names of earlier releases in an element and its children; `depth` is the nesting
  /// depth.
  static void rename_old(Element& element, int depth = 0);
  tinyxml2::XMLDocument xml_;          ///< the elements
  std::string file_;                   ///< name of the file
  std::set<std::string> other_files_;  ///< file names to which `places_` refers
  std::deque<Place> places_;  ///< positions of created elements, whose user data points here
  std::size_t elements_ = 0;  ///< number of elements in the parsed text
  bool foreign_ = false;      ///< true: written for another simulator
};

/// Returns the path of an element such as "world/navvy:soil[loam]/cohesion_pa". Brackets contain
/// the element's name or, without a name, its 1-based index among siblings with the same tag.
std::string element_path(const Element& element);
/// Returns the first child with the tag `kind` whose attribute `name` has this value; null if there
/// is none.
const Element* named_child(const Element& parent, const char* kind, const std::string& name);
/// Returns the text directly inside the element, without that of children, and trimmed.
std::string text_of(const Element& element);
/// Returns the trimmed text of the first child with this name; an empty text if there is none.
std::string child_text(const Element& element, const char* name);
/// Returns the value of an attribute; an empty text if there is none.
std::string attribute(const Element& element, const char* name);
/// Returns true for an element in the namespace `navvy:`, false for an SDF element.
bool is_extension(const Element& element);

/// Splits a text at blanks and line breaks into words.
std::vector<std::string> words_of(const std::string& text);
/// Reads the whole text as a number into `value`, independently of the locale; NaN and infinity
/// count as numbers. Returns false if the text is not a number.
bool to_number(const std::string& text, double& value);

}  // namespace navvy::scene_io
