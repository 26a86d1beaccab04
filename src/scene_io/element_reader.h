// SPDX-License-Identifier: Apache-2.0
// Reads the children of an XML element into a struct that describes its fields (scene/fields.h).
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

/// Names to which fields may refer: the parts of a <model> as written in the file, even if its SDF
/// has errors, and the soils of a world.
struct Names {
  /// Names of the objects of each type.
  std::vector<std::string> links, joints, frames, shells, soils;
  /// Type attribute of each joint, e.g. "revolute", keyed by joint name.
  std::map<std::string, std::string> joint_type;

  /// Returns the names of all links, joints, frames and shells in a <model>, and the types of its
  /// joints; `soils` is empty.
  static Names of_model(const Element& model);
};

/// Visitor that reads one XML element into a struct. A member whose element is missing keeps its
/// value, the default of the struct. Errors are added to a list and never stop the reading. The
/// objects passed to the constructor must outlive the reader.
class ElementReader final : public scene::Fields {
 public:
  /// @param names names to which fields may refer; null: references are not checked
  /// @param mixed true: the element itself belongs to SDF, so only its children in the namespace
  /// `navvy:` are read
  ElementReader(Element& element, const Names* names, Faults& faults, bool mixed = false)
      : element_(element), names_(names), faults_(faults), mixed_(mixed) {}

  /// Reads a field from a child element or attribute.
  void field(const scene::Field& field) override;
  /// Reads a child element with fields of its own.
  void group(const scene::Group& group,
             const std::function<void(scene::Fields&)>& describe) override;
  /// Appends one item per child element of the list, in the order of the file.
  void list(const scene::List& list) override;
  /// Selects the type given by the attribute, then reads the fields of that type.
  void types(const scene::Types& types) override;
  /// Reports unknown and repeated children, unknown attributes, and text between elements. Must be
  /// called after all fields have been visited.
  void finish();

 private:
  /// Returns the child `name` and records that this name is allowed; null if there is none. Reports
  /// a missing required child and sets the flag of `given`.
  Element* take(const scene::Mark& mark, const char* name);
  /// Reads a field that is an attribute.
  void read_attribute(const scene::Field& field);
  /// Reads the attribute of a value's element `child` and reports unknown ones.
  void read_value_attribute(const Element& child, const scene::ValueAttribute& attribute);
  /// Reads a child element with a reader of its own, which `describe` visits.
  void read_inside(Element& child, const std::function<void(scene::Fields&)>& describe);
  /// Reports an error at `child` if there is no object `name` of the type `refers`.
  void check_reference(const Element& child, const std::string& name, scene::Refers refers);
  Element& element_;    ///< the element that is read
  const Names* names_;  ///< names to which fields may refer; null: references are not checked
  Faults& faults_;      ///< list to which errors are added
  bool mixed_;          ///< true: only children in the namespace `navvy:` are read
  /// Names of allowed children, of those that may occur several times, of those among them that are
  /// points, of those with children of their own, of values with an attribute, and of allowed
  /// attributes; each is filled while fields are visited.
  std::vector<std::string> known_, repeatable_, points_, nested_, attributed_, attributes_;
};

/// Reads the struct `into`, which has a function `describe`, from an element and reports everything
/// in the element that does not belong to the struct.
template <class T>
void read_element(Element& element, T& into, const Names* names, Faults& faults) {
  ElementReader reader(element, names, faults);
  into.describe(reader);
  reader.finish();
}

/// Returns true if the element has a child with this name, whether that is valid or not.
inline bool has(const Element& element, const char* name) {
  return element.FirstChildElement(name) != nullptr;
}
/// Returns the first child with this name, or `element` itself if there is none. Use it to report
/// errors at the best position.
const Element& child_or_self(const Element& element, const char* name);
/// Returns the children with any of these names, in the order of the file.
std::vector<Element*> children_of(Element& parent, std::initializer_list<const char*> names);
/// Copies what is in `from` and not in `to`; elements that hold elements are merged.
void add_missing(Element& to, const Element& from);
/// Reports an error at the element `at` unless `name` is one of `names`. `what` describes the
/// missing object in the message, e.g. "link of this name in the model". Returns true if the name
/// is one of them.
bool require_name(const Element& at, const std::string& name, const std::string& what,
                  const std::vector<std::string>& names, Faults& faults);
/// Returns the member `name` of each object in a list.
template <class List>
std::vector<std::string> names_in_list(const List& objects) {
  std::vector<std::string> names;
  names.reserve(objects.size());
  for (const auto& object : objects) names.push_back(object.name);
  return names;
}

/// Reads exactly `count` numbers (0: any number of them) from the text of an element into `out`,
/// each within `range`. Returns false after an error.
bool read_numbers(const Element& element, std::size_t count, Range range, std::vector<double>& out,
                  Faults& faults);
/// Reads true, false, 1 or 0 into `out`. Returns false after an error.
bool read_flag(const Element& element, bool& out, Faults& faults);
/// Reads an unsigned integer of up to 64 bits into `out`. Returns false after an error.
bool read_seed(const Element& element, std::uint64_t& out, Faults& faults);
/// Reads an SDF <pose> into `out`: x y z [m] roll pitch yaw [rad], in degrees with the attribute
/// `degrees`, or x y z qx qy qz qw with rotation_format="quat_xyzw". Returns false after an error.
bool read_pose(const Element& element, Pose& out, Faults& faults);
/// Returns true if the text is one of SDF's spellings of true: "true" or "1".
inline bool is_true(const std::string& text) { return text == "true" || text == "1"; }

}  // namespace navvy::scene_io
