// SPDX-License-Identifier: Apache-2.0
// Reads the children of one element into a struct by the fields that it describes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/math.h"
#include "scene/fields.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

using scene::kDegree;
using scene::Range;

/// Names that reference fields may contain: parts of a <model> (collected from the XML, even if its
/// SDF has errors) and soils of a world.
struct Names {
  std::vector<std::string> links, joints, frames, shells, soils;
  std::map<std::string, std::string> joint_type;

  /// Collects the names of links, joints, frames and shells in a <model>.
  static Names of_model(const Element& model);
};

/// Visitor that reads one XML element into the struct that is being visited. An absent child
/// element leaves its member unchanged, so the struct's initial values are the defaults. Errors are
/// added to a list and do not stop reading. Element, names and list must exist longer than the
/// reader.
class ElementReader final : public scene::Fields {
 public:
  /// @param names known names; null if references shall not be checked
  /// @param mixed true for SDF elements, of which only children in the namespace navvy: are read
  ElementReader(Element& element, const Names* names, Faults& faults, bool mixed = false)
      : element_(element), names_(names), faults_(faults), mixed_(mixed) {}

  void field(const scene::Field& field) override;
  void group(const scene::Group& group,
             const std::function<void(scene::Fields&)>& describe) override;
  void list(const scene::List& list) override;
  void types(const scene::Types& types) override;
  /// Reports unknown and repeated child elements, unknown attributes and stray text. Must be called
  /// after all fields were visited.
  void finish();

 private:
  Element* take(const scene::Mark& mark, const char* name);
  void read_attribute(const scene::Field& field);
  void read_inside(Element& child, const std::function<void(scene::Fields&)>& describe);
  void check_reference(const Element& child, const std::string& name, scene::Refers refers);
  Element& element_;
  const Names* names_;
  Faults& faults_;
  bool mixed_;
  std::vector<std::string> known_, repeatable_, nested_, attributes_;
};

/// Reads `into`, a struct with `describe`, from an element of its own.
template <class T>
void read_element(Element& element, T& into, const Names* names, Faults& faults) {
  ElementReader reader(element, names, faults);
  into.describe(reader);
  reader.finish();
}

/// Returns true if the element has a child element of this name, even an invalid one.
inline bool has(const Element& element, const char* name) {
  return element.FirstChildElement(name) != nullptr;
}
/// Returns the child element of this name; the element itself if there is no such child. For
/// messages.
const Element& child_or_self(const Element& element, const char* name);
/// Returns all child elements that have one of these names, in the order of the file.
std::vector<Element*> children_of(Element& parent, std::initializer_list<const char*> names);
/// Reports an error at `at` unless `name` is one of `names`. `what` describes the object for the
/// message, e.g. "link of this name in the model". Returns true if the name is known.
bool require_name(const Element& at, const std::string& name, const std::string& what,
                  const std::vector<std::string>& names, Faults& faults);
/// Returns the names of the objects in a list.
template <class List>
std::vector<std::string> names_in_list(const List& objects) {
  std::vector<std::string> names;
  for (const auto& object : objects) names.push_back(object.name);
  return names;
}

/// Reads exactly `count` numbers (any number of them if `count` is 0) from the element's text. Each
/// must be within `range`. Returns false after an error.
bool read_numbers(const Element& element, std::size_t count, Range range, std::vector<double>& out,
                  Faults& faults);
bool read_flag(const Element& element, bool& out, Faults& faults);
/// Reads an unsigned 64-bit number. Returns false after an error.
bool read_seed(const Element& element, std::uint64_t& out, Faults& faults);
/// Reads an SDF <pose>: x y z roll pitch yaw, or x y z qx qy qz qw if the attribute rotation_format
/// says so. Returns false after an error.
bool read_pose(const Element& element, Pose& out, Faults& faults);
/// Returns true if the text of a boolean element means true: "true" or "1".
inline bool is_true(const std::string& text) { return text == "true" || text == "1"; }

}  // namespace navvy::scene_io
