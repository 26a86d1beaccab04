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

/// What reading has taken so far. Counted, because the limits of core/limits.h hold for a scene as
/// a whole.
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

/// Collects faults; an element added by an override (line 0) is reported as coming from the command
/// line. Readers go on after a fault, so one list holds all of a scene and of the files it names;
/// of very many the first are told, and how many more there are.
class Faults {
 public:
  /// `at` gives file, line and path; `value` is what was found, `rule` what is allowed, `remedy`
  /// what to do.
  void error(const Element& at, const std::string& value, const std::string& rule,
             const std::string& remedy = "");
  void warning(const Element& at, const std::string& value, const std::string& rule,
               const std::string& remedy = "");
  /// `suggestion` of core/edit_distance.h, a list of all that is known only the first time; or
  /// nothing when the fault would not be told: it is dear.
  std::string nearest(const std::string& word, const std::vector<std::string>& candidates) const;
  void add(Fault fault);
  /// Returns true if an error was reported at `element` or inside it. Rules among several fields
  /// skip elements with faults of their own.
  bool blamed(const Element& element) const { return blamed_.count(&element) > 0; }
  bool has_errors() const { return error_count() > 0; }
  /// All of them, told or not.
  std::size_t error_count() const { return errors_.all; }
  std::size_t warning_count() const { return warnings_.all; }
  const std::vector<Fault>& list() const { return list_; }
  /// Throws InputError with the whole list if it holds an error; else logs the warnings.
  void finish() const;

  Work work;

 private:
  /// Faults of one severity, and where the list says how many were left out.
  struct Told {
    std::size_t all = 0, rest_at = 0;
  };
  Told& told(Fault::Severity severity) {
    return severity == Fault::Severity::kError ? errors_ : warnings_;
  }
  /// Counts one more fault; false when it is not to be told.
  bool count(Fault::Severity severity);
  void add_at(Fault::Severity severity, const Element& at, const std::string& value,
              const std::string& rule, const std::string& remedy);
  std::vector<Fault> list_;
  Told errors_, warnings_;
  mutable std::set<std::string> listed_;
  std::set<const void*> blamed_;  ///< elements with errors, and all around them
};

/// Where an element was written.
struct Place {
  const std::string* file = nullptr;  ///< null: on the command line
  int line = 0;
};
Place place_of(const Element& element);

/// One XML file. Its elements live as long as it does. It is made on the heap and stays where it
/// is, as its elements lead back to it.
class Document {
 public:
  /// Null after a fault (missing, unreadable, not XML).
  static std::unique_ptr<Document> open(const std::string& file, Faults& faults);
  static std::unique_ptr<Document> parse(const std::string& text, const std::string& name,
                                         Faults& faults);
  /// The document an element belongs to.
  static const Document& of(const Element& element);

  const std::string& file() const { return file_; }
  /// A new element of this document that tells the place of `from`, of any document, as its own.
  Element* create(const char* name, const Element& from);
  std::string directory() const;
  Element* root() { return xml_.RootElement(); }
  std::size_t elements() const { return elements_; }
  /// The file's text as it is now, comments included.
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

/// "world/navvy:soil[loam]/cohesion_pa": names in brackets, or the 1-based place among equal
/// siblings.
std::string element_path(const Element& element);
/// The first child <kind> whose attribute `name` is this; null when there is none.
const Element* named_child(const Element& parent, const char* kind, const std::string& name);
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
/// The whole of `text` as a number, whatever the locale. False: not a number (nan and inf are
/// numbers here).
bool to_number(const std::string& text, double& value);

}  // namespace navvy::scene_io
