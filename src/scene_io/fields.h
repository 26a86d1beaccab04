// SPDX-License-Identifier: Apache-2.0
// A table-driven reader of one element's children: each line of a table gives name (with unit),
// target, range and the factor to SI. `finish` reports what the table does not know, so nothing is
// ever skipped in silence.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/math.h"
#include "scene/field_source.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

using scene::kDegree;
using scene::Range;

/// Reads the children of one element by their names and units, one call a child, in any order of
/// the file. A child that is absent leaves its target as it is, so defaults stand in the structs
/// alone. Faults go to a list and never stop the reading. Both arguments must outlive it.
class Fields {
 public:
  Fields(Element& element, Faults& faults) : element_(element), faults_(faults) {}

  /// The value in the struct is the written one times `factor`; the range is of the written one, as
  /// messages quote it.
  Fields& number(const char* name, double& out, Range range, double factor = 1);
  Fields& number(const char* name, float& out, Range range);
  Fields& whole(const char* name, int& out, Range range);
  Fields& whole(const char* name, std::uint64_t& out);
  /// Text without blanks around it; an empty element is a fault.
  Fields& text(const char* name, std::string& out);
  Fields& flag(const char* name, bool& out);
  /// Two or three numbers in one element, each within the range.
  Fields& vec2(const char* name, Vec2& out, Range range = {-1e7, 1e7});
  Fields& vec3(const char* name, Vec3& out, Range range = {-1e3, 1e3});
  /// Must not be zero; is normalised.
  Fields& direction(const char* name, Vec3& out);
  /// Any number of numbers.
  Fields& list(const char* name, std::vector<double>& out, Range range, double factor = 1);
  template <class T>
  Fields& choice(const char* name, T& out, const std::vector<std::pair<std::string, T>>& choices) {
    if (Element* child = take(name)) {
      std::vector<std::string> names;
      const std::string value = text_of(*child);
      for (const auto& [key, result] : choices) {
        names.push_back(key);
        if (key == value) out = result;
      }
      one_of(*child, value, names);
    }
    return *this;
  }
  /// Children that may occur any number of times, handled by `read` in file order. The elements are
  /// read by tables of their own.
  Fields& each(const char* name, const std::function<void(Element&)>& read);
  /// A child that holds elements of its own and occurs at most once.
  Fields& nested(const char* name, const std::function<void(Element&)>& read);
  /// The element must be there. A default would hide that it was forgotten.
  Fields& required(const char* name);
  /// An attribute that is allowed here.
  Fields& attribute(const char* name);
  /// Whether the child stands in the file, whatever its value.
  bool has(const char* name) const { return element_.FirstChildElement(name) != nullptr; }
  Element* child(const char* name) const { return element_.FirstChildElement(name); }
  /// Reports unknown children, repeated ones, unknown attributes and stray text. Call it last: what
  /// has not been asked for by then is unknown.
  void finish();

 private:
  Element* take(const char* name);
  void one_of(const Element& child, const std::string& value,
              const std::vector<std::string>& names);
  Element& element_;
  Faults& faults_;
  std::vector<std::string> known_, repeatable_, nested_, attributes_;
};

/// Reads exactly `count` (0: any number) numbers of an element's text. False after a fault. The
/// range holds for each of them.
bool read_numbers(const Element& element, std::size_t count, Range range, std::vector<double>& out,
                  Faults& faults);
bool read_flag(const Element& element, bool& out, Faults& faults);
/// SDF <pose>: x y z roll pitch yaw, or x y z qx qy qz qw with rotation_format. False after a
/// fault.
bool read_pose(const Element& element, Pose& out, Faults& faults);

}  // namespace navvy::scene_io
