// SPDX-License-Identifier: Apache-2.0
// Describes the fields of a scene's structs once. Every struct of `scene` has a member function
// `describe(Fields&)` that lists its fields: element name with unit, member, range and one sentence
// of documentation. The reader of scene files, `--set`, the parameters that two scenes are compared
// by, `navvy schema` and the reference page are visitors of these lists.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/math.h"

namespace navvy::scene {

/// Closed range of allowed values, in the unit that the scene file uses.
struct Range {
  double min = -std::numeric_limits<double>::max();
  double max = std::numeric_limits<double>::max();
};
/// Number of radians in a degree.
inline constexpr double kDegree = kPi / 180.0;

/// Unit of a scene-file element, derived from the suffix of the element's name:
/// `friction_angle_deg` is in degrees.
struct Unit {
  /// Unit symbol such as "deg"; "-" for a dimensionless number.
  const char* symbol;  ///< "deg"; "-" for a number without a unit
  /// Factor that converts a value in this unit to SI units.
  double factor;
};
/// Returns the unit of the element or attribute called `name`; dimensionless if the suffix is
/// unknown.
Unit unit_of(std::string_view name);
/// Formats `value` with at most `digits` significant digits.
std::string short_text(double value, int digits = 9);
/// Formats an SI value in the file's unit (SI value = file value x `factor`) as the shortest text
/// that reads back to exactly the same SI value.
std::string exact_text(double in_si, double factor = 1);

/// Type of the object whose name a text field contains; kNothing for ordinary text.
enum class Refers { kNothing, kLink, kJoint, kShell, kSoil, kHitch };

/// Options of a field. Combine several with `|`.
struct Mark {
  enum Bit : unsigned {
    /// The element is mandatory.
    kNeeded = 1,
    /// The field affects only what a run shows or writes, so it is not part of the scene's
    /// parameters.
    kShown = 2,
    /// The element belongs to standard SDF; libsdformat reads it.
    kSdf = 4,
    /// The field is an XML attribute of the element, not a child element.
    kAttribute = 8,
    /// The value is computed from other elements: it is a parameter, but no element contains it.
    kDerived = 16,
    /// A dedicated reader handles the element; generic visitors skip its contents.
    kOwnReader = 32,
  };
  unsigned bits = 0;
  /// Set to true if the element is present in the file; may be null.
  bool* given = nullptr;

  bool has(Bit bit) const { return (bits & bit) != 0; }
};
inline constexpr Mark kNeeded{Mark::kNeeded};
inline constexpr Mark kShown{Mark::kShown};
inline constexpr Mark kSdf{Mark::kSdf};
inline constexpr Mark kOwnReader{Mark::kOwnReader};
/// Returns an option that sets `flag` to true if the element is present. If the element is absent,
/// the field has no value.
inline Mark given(bool& flag) { return {0, &flag}; }
constexpr Mark operator|(Mark a, Mark b) { return {a.bits | b.bits, a.given ? a.given : b.given}; }

/// Access to an enumeration or bool member whose values have names in scene files.
struct NamedChoice {
  std::vector<const char*> names;
  std::function<std::size_t()> get;
  std::function<void(std::size_t)> set;
};
/// Access to a unit-vector member. The reader normalizes the vector from the file.
struct Direction {
  Vec3* value;
};
/// Access to a linear RGB color: three floats from 0 to 1.
struct Rgb {
  float* value;
};
/// Function that computes a derived field's text when a visitor needs it.
using Computed = std::function<std::string()>;
/// Access to the struct member (or computed text) behind a field. Pointers refer to the described
/// object.
using Value = std::variant<bool*, int*, std::uint64_t*, double*, std::string*, Vec2*, Vec3*, Pose*,
                           Mat3*, std::vector<double>*, std::vector<Vec3>*, std::optional<int>*,
                           Direction, Rgb, NamedChoice, Computed>;

/// Formats a field's current value in the file's unit (SI value = file value x `factor`) without
/// loss of precision.
std::string value_text(const Value& value, double factor);

/// Description of one element or attribute that holds a value.
struct Field {
  const char* name;  ///< element or attribute; ends in the unit
  Value value;
  Range range;
  const char* text;  ///< one sentence for the reference
  Mark mark;
  Refers refers = Refers::kNothing;
};

/// Description of a child element that contains fields of its own.
struct Group {
  const char* name;
  const char* text;
  Mark mark;
  /// False if the struct's optional member is empty; a reader then calls `make` first.
  bool present = true;
  /// Creates the optional member before the reader fills it. Empty if the member always exists.
  std::function<void()> make = {};
};

class Fields;

/// Description of child elements that may occur several times. They may be of several types
/// (element names); the order of the file is kept.
struct List {
  struct Kind {
    const char* name;  ///< of the element
    const char* text;
  };
  const char* name;  ///< of an item in parameter paths and in `--set`
  /// Allowed element names, at least one.
  std::vector<Kind> kinds;
  /// Maximum number of items of each element name.
  std::size_t most;
  Mark mark;
  /// Current number of items.
  std::size_t size;
  /// Visits the fields of the item with this index.
  std::function<void(std::size_t item, Fields&)> item;
  /// Appends an item of the type with this index in `kinds`, then visits the item's fields.
  std::function<void(std::size_t kind, Fields&)> add;
  /// Visits the fields of a temporary item with default values, of the type with this index in
  /// `kinds`.
  std::function<void(std::size_t kind, Fields&)> fresh;
};

/// Description of an attribute that selects which fields an element has, such as the type of a
/// drive. The first name is the default.
struct Types {
  const char* attribute;
  const char* text;
  std::vector<const char*> names;
  /// Index in `names` of the current type.
  std::size_t index;
  std::function<void(std::size_t type)> choose;
  std::function<void(std::size_t type, Fields&)> describe;
};

/// First value and documentation of one kind of list item.
template <class T>
/// Initial value and documentation of one type of list item.
struct Start {
  const char* name;
  const char* text;
  T value;
};

/// Visitor of a struct's fields.
///
/// A struct's `describe` function calls one of the operators below once for each field. The
/// operators pass a type-independent description to the virtual functions, which a visitor
/// implements. Only visitors that read a file modify the members.
class Fields {
 public:
  virtual ~Fields() = default;

  /// Visits a member with one value: a flag, number, text, vector, list of numbers or pose.
  template <class T>
  void operator()(const char* name, T& member, Range range, const char* text, Mark mark = {}) {
    field({name, &member, range, text, mark});
  }
  /// Visits a member that has the usual range of its type, or a struct as a child element.
  template <class T>
  void operator()(const char* name, T& member, const char* text, Mark mark = {}) {
    if constexpr (requires { member.describe(*this); })
      group({name, text, mark, true, {}}, [&member](Fields& f) { member.describe(f); });
    else
      field({name, &member, usual_range(member), text, mark});
  }
  /// Visits a text field that contains the name of another object.
  void operator()(const char* name, std::string& member, Refers refers, const char* text,
                  Mark mark = {}) {
    field({name, &member, {}, text, mark, refers});
  }
  void operator()(const char* name, Direction member, const char* text, Mark mark = {}) {
    field({name, member, {-1e6, 1e6}, text, mark});
  }
  void operator()(const char* name, Rgb member, const char* text, Mark mark = {}) {
    field({name, member, {0, 1}, text, mark});
  }
  /// Visits an enumeration or flag by the names of its values.
  template <class T>
  void operator()(const char* name, T& member, std::vector<std::pair<const char*, T>> choices,
                  const char* text, Mark mark = {}) {
    NamedChoice choice;
    for (const auto& [key, value] : choices) choice.names.push_back(key);
    choice.get = [&member, choices] {
      std::size_t i = 0;
      while (i + 1 < choices.size() && choices[i].second != member) ++i;
      return i;
    };
    choice.set = [&member, choices](std::size_t i) { member = choices.at(i).second; };
    field({name, std::move(choice), {}, text, mark});
  }
  /// Visits a child element that may be absent. It exists if it has a value.
  template <class T>
  void operator()(const char* name, std::optional<T>& member, const char* text, Mark mark = {}) {
    group({name, text, mark, member.has_value(), [&member] { member.emplace(); }},
          [&member](Fields& f) {
            T fresh;
            (member ? *member : fresh).describe(f);
          });
  }
  /// Visits child elements, at most `most` of them.
  template <class T>
  void operator()(const char* name, std::vector<T>& items, std::size_t most, const char* text,
                  Mark mark = {}) {
    list(name, items, most, std::vector<Start<T>>{{name, text, T()}}, mark);
  }
  /// Visits child elements of several kinds, at most `most` of each. The file's order is kept.
  template <class T>
  void list(const char* name, std::vector<T>& items, std::size_t most,
            const std::vector<Start<T>>& starts, Mark mark = {}) {
    List out{name, {}, most, mark, items.size(), {}, {}, {}};
    for (const Start<T>& start : starts) out.kinds.push_back({start.name, start.text});
    out.item = [&items](std::size_t i, Fields& f) { items.at(i).describe(f); };
    out.add = [&items, &starts](std::size_t kind, Fields& f) {
      items.push_back(starts.at(kind).value);
      items.back().describe(f);
    };
    out.fresh = [&starts](std::size_t kind, Fields& f) {
      T value = starts.at(kind).value;
      value.describe(f);
    };
    list(out);
  }
  /// Visits an XML attribute of the element that is being described.
  void attribute(const char* name, std::string& member, const char* text, Mark mark = {}) {
    field({name, &member, {}, text, mark | Mark{Mark::kAttribute}});
  }
  /// Visits a parameter that has no element of its own.
  template <class T>
  void derived(const char* name, T& member) {
    field({name, &member, {}, "", {Mark::kDerived}});
  }
  void derived_text(const char* name, Computed text) {
    field({name, std::move(text), {}, "", {Mark::kDerived}});
  }
  /// Visits an enumeration that follows from other elements.
  template <class T>
  void derived_kind(const char* name, T kind) {
    derived_text(name, [kind] { return std::to_string(static_cast<int>(kind)); });
  }

  virtual void field(const Field& field) = 0;
  virtual void group(const Group& group, const std::function<void(Fields&)>& describe) = 0;
  virtual void list(const List& list) = 0;
  virtual void types(const Types& types) = 0;
  /// Visits fields that another file contains, such as those of a machine behind an <include>. Only
  /// the parameter visitor follows them; other visitors ignore the call.
  virtual void elsewhere(const std::function<void(Fields&)>& /*describe*/) {}

 private:
  static Range usual_range(const Vec2&) { return {-1e7, 1e7}; }
  static Range usual_range(const Vec3&) { return {-1e3, 1e3}; }
  template <class T>
  static Range usual_range(const T&) {
    return {};
  }
};

/// A numeric field of a struct, with the name of the element that contains it.
struct NamedNumber {
  const char* name;
  /// Points to the member, in SI units.
  double* value;
  double low, high;  ///< allowed range, bounds included, in the unit of the file
  /// Factor that converts a value in the file's unit to SI units.
  double factor = 1;
  bool parameter = true;

  double written() const { return *value / factor; }
};
/// Returns the numeric fields that `describe` visits, except those inside child elements. The
/// results point into the described object.
std::vector<NamedNumber> numbers_of(const std::function<void(Fields&)>& describe);
/// Returns the name that identifies the object visited by `describe`: the attribute `name`, else
/// the first reference to another object; empty if there is neither.
std::string name_of(const std::function<void(Fields&)>& describe);

}  // namespace navvy::scene
