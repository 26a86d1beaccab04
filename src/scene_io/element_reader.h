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

/// Names that fields may refer to: of a <model> as written, even where its SDF has faults, and of a
/// world's soils.
struct Names {
  std::vector<std::string> links, joints, frames, shells, soils;
  std::map<std::string, std::string> joint_type;

  /// Collects the names of a <model>.
  static Names of_model(const Element& model);
};

/// Visitor that reads one element. Absent children leave their members unchanged, so defaults are
/// those of the structs. Faults go to a list and never stop the reading. References must outlive
/// the reader.
class ElementReader final : public scene::Fields {
 public:
  /// @param names known names; null: references are not checked
  /// @param mixed the element belongs to SDF: reads children in the namespace navvy: alone
  ElementReader(Element& element, const Names* names, Faults& faults, bool mixed = false)
      : element_(element), names_(names), faults_(faults), mixed_(mixed) {}

  void field(const scene::Field& field) override;
  void group(const scene::Group& group,
             const std::function<void(scene::Fields&)>& describe) override;
  void list(const scene::List& list) override;
  void types(const scene::Types& types) override;
  /// Reports unknown and repeated children, unknown attributes and stray text. Call it last.
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

/// Returns true if the element has a child of this name, valid or not.
inline bool has(const Element& element, const char* name) {
  return element.FirstChildElement(name) != nullptr;
}
/// Returns the child of this name, or the element itself if there is none. For messages.
const Element& child_or_self(const Element& element, const char* name);
/// Returns the children with one of these names, in the order of the file.
std::vector<Element*> children_of(Element& parent, std::initializer_list<const char*> names);
/// Reports `name`, written at `at`, unless it is one of `names`. `what` is the kind of thing, such
/// as "link of this name in the model". Returns true if the name is known.
bool require_name(const Element& at, const std::string& name, const std::string& what,
                  const std::vector<std::string>& names, Faults& faults);
/// Returns the names of the objects in a list.
template <class List>
std::vector<std::string> names_in_list(const List& objects) {
  std::vector<std::string> names;
  for (const auto& object : objects) names.push_back(object.name);
  return names;
}

/// Reads exactly `count` (0: any number) numbers of an element's text, each within the range.
/// Returns false after a fault.
bool read_numbers(const Element& element, std::size_t count, Range range, std::vector<double>& out,
                  Faults& faults);
bool read_flag(const Element& element, bool& out, Faults& faults);
/// Reads a whole number without sign, of 64 bits. Returns false after a fault.
bool read_seed(const Element& element, std::uint64_t& out, Faults& faults);
/// Reads an SDF <pose>: x y z roll pitch yaw, or x y z qx qy qz qw with rotation_format. Returns
/// false after a fault.
bool read_pose(const Element& element, Pose& out, Faults& faults);
/// Returns true for the text of a flag that is set.
inline bool is_true(const std::string& text) { return text == "true" || text == "1"; }

}  // namespace navvy::scene_io
