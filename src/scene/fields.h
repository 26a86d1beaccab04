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

/// Closed range of a value in the unit of the file.
struct Range {
  double min = -std::numeric_limits<double>::max();
  double max = std::numeric_limits<double>::max();
};
/// Number of radians in a degree.
inline constexpr double kDegree = kPi / 180.0;

/// Unit of a field, from the suffix of its name: `friction_angle_deg` is in degrees.
struct Unit {
  const char* symbol;  ///< "deg"; "-" for a number without a unit
  double factor;       ///< SI value / value in the file
};
/// Returns the unit of a field by its name.
Unit unit_of(std::string_view name);
/// Returns `value` with at most `digits` significant digits.
std::string short_text(double value, int digits = 9);
/// Returns the shortest text in the file's unit that reads back to exactly this SI value.
std::string exact_text(double in_si, double factor = 1);

/// Kind of object that the text of a field names.
enum class Refers { kNothing, kLink, kJoint, kShell, kSoil, kHitch };

/// Options of a field, joined by `|`.
struct Mark {
  enum Bit : unsigned {
    kNeeded = 1,      ///< the element must be given
    kShown = 2,       ///< changes what a run shows or writes, not what it computes: no parameter
    kSdf = 4,         ///< an element of SDF, which libsdformat reads
    kAttribute = 8,   ///< an attribute of the element, not a child
    kDerived = 16,    ///< follows from other elements: a parameter without an element
    kOwnReader = 32,  ///< an element that a reader of its own takes
  };
  unsigned bits = 0;
  bool* given = nullptr;  ///< receives true if the element is present

  bool has(Bit bit) const { return (bits & bit) != 0; }
};
inline constexpr Mark kNeeded{Mark::kNeeded};
inline constexpr Mark kShown{Mark::kShown};
inline constexpr Mark kSdf{Mark::kSdf};
inline constexpr Mark kOwnReader{Mark::kOwnReader};
/// Returns the option that stores in `flag` whether the element is present. Without the element the
/// field has no value of its own.
inline Mark given(bool& flag) { return {0, &flag}; }
constexpr Mark operator|(Mark a, Mark b) { return {a.bits | b.bits, a.given ? a.given : b.given}; }

/// Reference to an enumeration or flag that a file writes by name.
struct NamedChoice {
  std::vector<const char*> names;
  std::function<std::size_t()> get;
  std::function<void(std::size_t)> set;
};
/// Reference to a unit vector; the reader normalizes it.
struct Direction {
  Vec3* value;
};
/// Reference to a linear RGB color, each component from 0 to 1.
struct Rgb {
  float* value;
};
/// Text that is computed on demand; for derived fields.
using Computed = std::function<std::string()>;
/// Reference to the member behind a field.
using Value = std::variant<bool*, int*, std::uint64_t*, double*, std::string*, Vec2*, Vec3*, Pose*,
                           Mat3*, std::vector<double>*, std::vector<Vec3>*, std::optional<int>*,
                           Direction, Rgb, NamedChoice, Computed>;

/// Returns the value of a field as text in the unit of its file, exact to the last bit.
std::string value_text(const Value& value, double factor);

/// One field with a value.
struct Field {
  const char* name;  ///< element or attribute; ends in the unit
  Value value;
  Range range;
  const char* text;  ///< one sentence for the reference
  Mark mark;
  Refers refers = Refers::kNothing;
};

/// A child element that holds fields of its own.
struct Group {
  const char* name;
  const char* text;
  Mark mark;
  bool present = true;  ///< the struct has a value, see `make`
  /// Creates an optional value when the element is read; may be empty.
  std::function<void()> make = {};
};

class Fields;

/// Child elements that may occur several times, of one or several kinds, in the order of the file.
struct List {
  struct Kind {
    const char* name;  ///< of the element
    const char* text;
  };
  const char* name;         ///< of an item in parameter paths and in `--set`
  std::vector<Kind> kinds;  ///< one at least
  std::size_t most;         ///< limit of the number of items of a kind
  Mark mark;
  std::size_t size;                                      ///< present number of items
  std::function<void(std::size_t item, Fields&)> item;   ///< describes an item
  std::function<void(std::size_t kind, Fields&)> add;    ///< appends an item, then describes it
  std::function<void(std::size_t kind, Fields&)> fresh;  ///< describes an item of default values
};

/// Fields that depend on an attribute, such as the type of a drive. The first name is the default.
struct Types {
  const char* attribute;
  const char* text;
  std::vector<const char*> names;
  std::size_t index;  ///< present type
  std::function<void(std::size_t type)> choose;
  std::function<void(std::size_t type, Fields&)> describe;
};

/// First value and documentation of one kind of list item.
template <class T>
struct Start {
  const char* name;
  const char* text;
  T value;
};

/// Visitor of the fields of a struct.
///
/// `describe` functions call the operators below once per field. The virtual functions do the work;
/// they see no types but those of `Value`. Only a visitor that reads a file writes to the members.
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
  /// Visits a name of another object.
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
  /// Visits an attribute of the element itself.
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
  /// Visits fields that a file describes elsewhere, as a machine's behind an <include>. Only
  /// parameters look into them.
  virtual void elsewhere(const std::function<void(Fields&)>& /*describe*/) {}

 private:
  static Range usual_range(const Vec2&) { return {-1e7, 1e7}; }
  static Range usual_range(const Vec3&) { return {-1e3, 1e3}; }
  template <class T>
  static Range usual_range(const T&) {
    return {};
  }
};

/// A number of a struct by its element name.
struct NamedNumber {
  const char* name;
  double* value;      ///< in SI units
  double low, high;   ///< allowed range, bounds included, in the unit of the file
  double factor = 1;  ///< SI value / value in the file
  bool parameter = true;

  double written() const { return *value / factor; }
};
/// Returns the numbers that `describe` lists directly, without those of child elements. They refer
/// to the described object.
std::vector<NamedNumber> numbers_of(const std::function<void(Fields&)>& describe);
/// Returns the name by which `describe` identifies its object: the attribute `name`, else
/// the first name of another object; empty without either.
std::string name_of(const std::function<void(Fields&)>& describe);

}  // namespace navvy::scene
