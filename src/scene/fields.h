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

/// Closed range of allowed values, in the unit of the file. Without explicit bounds, every finite
/// number is allowed.
struct Range {
  double min = -std::numeric_limits<double>::max();  ///< smallest allowed value
  double max = std::numeric_limits<double>::max();   ///< largest allowed value
};
/// Number of radians in one degree; factor from degrees to radians.
inline constexpr double kDegree = kPi / 180.0;

/// Unit of a field, given by the suffix of the field's name: `friction_angle_deg` is in degrees.
struct Unit {
  const char* symbol;  ///< symbol for messages, e.g. "deg"; "-" for a number without a unit
  double factor;       ///< SI value / value in the file
};
/// Returns the unit that the suffix of a field's name stands for; "-" with factor 1 if no suffix is
/// known.
Unit unit_of(std::string_view name);
/// Returns `value` as text with at most `digits` significant digits.
std::string short_text(double value, int digits = 9);
/// Returns the SI value `in_si` as a text in the file's unit, with the fewest digits that read back
/// to exactly this value. `factor` is SI value / value in the file. If no number in the file's unit
/// does so, the text is in SI units and ends in " (SI)".
std::string exact_text(double in_si, double factor = 1);

/// Type of the object whose name a text field holds; kNothing: the text is not a name of an object.
enum class Refers { kNothing, kLink, kJoint, kShell, kSoil, kHitch };

/// Options of a field: a combination of bits, joined by `|`, and an optional flag to set.
struct Mark {
  /// Options that can be combined in `bits`.
  enum Bit : unsigned {
    kNeeded = 1,  ///< the element is required
    /// The element affects what a run displays or writes, but not what it computes. It is therefore
    /// not a parameter (scene/parameters.h).
    kShown = 2,
    kSdf = 4,        ///< the element belongs to SDF, not to the namespace `navvy:`
    kAttribute = 8,  ///< the field is an attribute of the element, not a child element
    kDerived = 16,  ///< the value follows from other elements: it is a parameter but has no element
    kOwnReader = 32,  ///< the element has a reader of its own; the general reader skips it
  };
  unsigned bits = 0;      ///< combination of `Bit` values
  bool* given = nullptr;  ///< set to true by the reader if the element exists; null: not needed

  /// Returns true if the option `bit` is set.
  bool has(Bit bit) const { return (bits & bit) != 0; }
};
/// Option: the element is required (Mark::Bit::kNeeded).
inline constexpr Mark kNeeded{Mark::kNeeded};
/// Option: the value does not influence what a run computes (Mark::Bit::kShown).
inline constexpr Mark kShown{Mark::kShown};
/// Option: the element belongs to SDF (Mark::Bit::kSdf).
inline constexpr Mark kSdf{Mark::kSdf};
/// Option: the element has a reader of its own (Mark::Bit::kOwnReader).
inline constexpr Mark kOwnReader{Mark::kOwnReader};
/// Returns the option that makes the reader set `flag` to true if the element exists. If the
/// element is missing, the field counts as having no value.
inline Mark given(bool& flag) { return {0, &flag}; }
/// Returns the combination of two options; if both have a flag to set, that of `a` is used.
constexpr Mark operator|(Mark a, Mark b) { return {a.bits | b.bits, a.given ? a.given : b.given}; }

/// Accessors for an enumeration or a bool whose values a file writes by name.
struct NamedChoice {
  std::vector<const char*> names;        ///< names of the allowed values
  std::function<std::size_t()> get;      ///< returns the index in `names` of the current value
  std::function<void(std::size_t)> set;  ///< sets the value to that of an index in `names`
};
/// Attribute of an element that holds a value: an enumeration that says how the value is meant. The
/// first of its names is the default.
struct ValueAttribute {
  const char* name;    ///< name of the attribute
  NamedChoice choice;  ///< its allowed values
  const char* text;    ///< one sentence of documentation
};
/// Pointer to a unit vector; the reader normalizes the vector that a file gives.
struct Direction {
  Vec3* value;  ///< the unit vector
};
/// Pointer to the first of three floats, a linear RGB color with components from 0 to 1.
struct Rgb {
  float* value;  ///< the red component; green and blue follow
};
/// Function that computes the text of a derived field when it is needed.
using Computed = std::function<std::string()>;
/// Pointer to the struct member that stores the value of a field, or an object that gives access to
/// it.
using Value = std::variant<bool*, int*, std::uint64_t*, double*, std::string*, Vec2*, Vec3*, Pose*,
                           Mat3*, std::vector<double>*, std::vector<Vec3>*, std::optional<int>*,
                           Direction, Rgb, NamedChoice, Computed>;

/// Returns a field's value as text in the unit of the file, such that reading the text restores the
/// value exactly. `factor` is SI value / value in the file. Poses give an empty text.
std::string value_text(const Value& value, double factor);

/// A field with a value: its name, where the value is stored, and the rules for it.
struct Field {
  /// Name of the element or attribute, which ends in the unit.
  const char* name;
  Value value;  ///< where the value is stored
  Range range;  ///< allowed values, in the unit of the file
  /// One sentence of documentation for the reference page.
  const char* text;
  Mark mark;                         ///< options of the field
  Refers refers = Refers::kNothing;  ///< type of the object that the value names
  /// Attribute of the value's element, if it has one.
  std::optional<ValueAttribute> attribute = {};
};

/// Description of a child element that has fields of its own.
struct Group {
  const char* name;  ///< name of the child element
  const char* text;  ///< one sentence of documentation
  Mark mark;         ///< options of the child element
  /// False for an optional struct without a value; `make` then creates the value.
  bool present = true;
  /// Creates the optional struct when its element is read. Empty if the struct always exists.
  std::function<void()> make = {};
};

class Fields;

/// Description of child elements that may occur several times: the items of a list. The items may
/// be of one or several types, each with its own element name, and keep the order of the file.
struct List {
  /// One type of item.
  struct Kind {
    const char* name;  ///< name of the element
    const char* text;  ///< one sentence of documentation
  };
  const char* name;         ///< name of an item in parameter paths and in `--set`
  std::vector<Kind> kinds;  ///< the types of items, at least one
  std::size_t most;         ///< maximum number of items of each type
  Mark mark;                ///< options of the elements
  std::size_t size;         ///< current number of items
  /// Visits the fields of the item with index `item`.
  std::function<void(std::size_t item, Fields&)> item;
  /// Appends an item of the type `kinds[kind]`, then visits its fields.
  std::function<void(std::size_t kind, Fields&)> add;
  /// Visits the fields of a temporary item of the type `kinds[kind]` with default values, for
  /// documentation; the list is unchanged.
  std::function<void(std::size_t kind, Fields&)> fresh;
};

/// Description of fields that depend on the value of an attribute, such as the attribute `type` of
/// a drive. The first of `names` is the default.
struct Types {
  const char* attribute;           ///< name of the attribute
  const char* text;                ///< one sentence of documentation
  std::vector<const char*> names;  ///< allowed values of the attribute, one per type
  std::size_t index;               ///< index in `names` of the current type
  /// Replaces the object by one of the type `names[type]` with default values.
  std::function<void(std::size_t type)> choose;
  /// Visits the fields of the type `names[type]`, with default values if that is not the current
  /// type.
  std::function<void(std::size_t type, Fields&)> describe;
};

/// Element name, documentation and initial value of one type of list item.
template <class T>
struct Start {
  const char* name;  ///< name of the element
  const char* text;  ///< one sentence of documentation
  T value;           ///< value of a new item before its element is read
};

/// Visitor of the fields of a struct.
///
/// The `describe` function of a struct calls one operator or function below per field. These
/// forward to the virtual functions, which a visitor implements, and which see no types except
/// those of `Value`. Only a visitor that reads a file may write to the members.
class Fields {
 public:
  virtual ~Fields() = default;

  /// Visits a member with one value and an explicit range: a flag, number, text, vector, list of
  /// numbers or pose.
  template <class T>
  void operator()(const char* name, T& member, Range range, const char* text, Mark mark = {}) {
    field({name, &member, range, text, mark});
  }
  /// Visits a member without an explicit range. A struct with `describe` becomes a child element;
  /// any other member gets the usual range of its type.
  template <class T>
  void operator()(const char* name, T& member, const char* text, Mark mark = {}) {
    if constexpr (requires { member.describe(*this); })
      group({name, text, mark, true, {}}, [&member](Fields& f) { member.describe(f); });
    else
      field({name, &member, usual_range(member), text, mark});
  }
  /// Visits a text that is the name of another object, whose type is `refers`.
  void operator()(const char* name, std::string& member, Refers refers, const char* text,
                  Mark mark = {}) {
    field({name, &member, {}, text, mark, refers});
  }
  /// Visits a number whose element has an attribute.
  void operator()(const char* name, double& member, Range range, const char* text,
                  ValueAttribute attribute) {
    field({name, &member, range, text, {}, Refers::kNothing, std::move(attribute)});
  }
  /// Returns the accessors of an enumeration or flag. `choices` holds the name of each allowed
  /// value.
  template <class T>
  static NamedChoice choice_of(T& member, std::vector<std::pair<const char*, T>> choices) {
    NamedChoice choice;
    for (const auto& [key, value] : choices) choice.names.push_back(key);
    choice.get = [&member, choices] {
      std::size_t i = 0;
      while (i + 1 < choices.size() && choices[i].second != member) ++i;
      return i;
    };
    choice.set = [&member, choices](std::size_t i) { member = choices.at(i).second; };
    return choice;
  }
  /// Visits a unit vector.
  void operator()(const char* name, Direction member, const char* text, Mark mark = {}) {
    field({name, member, {-1e6, 1e6}, text, mark});
  }
  /// Visits a color.
  void operator()(const char* name, Rgb member, const char* text, Mark mark = {}) {
    field({name, member, {0, 1}, text, mark});
  }
  /// Visits an enumeration or flag. `choices` holds the name of each allowed value.
  template <class T>
  void operator()(const char* name, T& member, std::vector<std::pair<const char*, T>> choices,
                  const char* text, Mark mark = {}) {
    field({name, choice_of(member, std::move(choices)), {}, text, mark});
  }
  /// Visits a child element that may be missing; the element exists if `member` has a value.
  template <class T>
  void operator()(const char* name, std::optional<T>& member, const char* text, Mark mark = {}) {
    group({name, text, mark, member.has_value(), [&member] { member.emplace(); }},
          [&member](Fields& f) {
            T fresh;
            (member ? *member : fresh).describe(f);
          });
  }
  /// Visits child elements of one type, at most `most` of them.
  template <class T>
  void operator()(const char* name, std::vector<T>& items, std::size_t most, const char* text,
                  Mark mark = {}) {
    list(name, items, most, std::vector<Start<T>>{{name, text, T()}}, mark);
  }
  /// Visits child elements of several types, at most `most` of each type. `items` keeps the order
  /// of the file; `starts` has one entry per type.
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
  /// Visits an attribute of the element that is being described.
  void attribute(const char* name, std::string& member, const char* text, Mark mark = {}) {
    field({name, &member, {}, text, mark | Mark{Mark::kAttribute}});
  }
  /// Visits a value that is a parameter of the scene but has no element of its own.
  template <class T>
  void derived(const char* name, T& member) {
    field({name, &member, {}, "", {Mark::kDerived}});
  }
  /// Visits a parameter without an element whose text is computed when it is needed.
  void derived_text(const char* name, Computed text) {
    field({name, std::move(text), {}, "", {Mark::kDerived}});
  }
  /// Visits items without elements of their own, whose fields are parameters of the scene.
  template <class T>
  void derived_list(const char* name, std::vector<T>& items) {
    list(name, items, std::numeric_limits<std::size_t>::max(),
         std::vector<Start<T>>{{name, "", T()}}, {Mark::kDerived});
  }
  /// Visits an enumeration that follows from other elements; its parameter is the integer value.
  template <class T>
  void derived_kind(const char* name, T kind) {
    derived_text(name, [kind] { return std::to_string(static_cast<int>(kind)); });
  }

  /// Handles a field with a value.
  virtual void field(const Field& field) = 0;
  /// Handles a child element with fields; `describe` visits these fields.
  virtual void group(const Group& group, const std::function<void(Fields&)>& describe) = 0;
  /// Handles child elements that may occur several times.
  virtual void list(const List& list) = 0;
  /// Handles fields that depend on the value of an attribute, such as the type of a drive.
  virtual void types(const Types& types) = 0;
  /// Handles fields that another file describes, such as those of an included machine. Does nothing
  /// by default; only the writer of scene parameters overrides it.
  virtual void elsewhere(const std::function<void(Fields&)>& /*describe*/) {}

 private:
  /// Returns the range of a member without an explicit range, by its type.
  static Range usual_range(const Vec2&) { return {-1e7, 1e7}; }
  static Range usual_range(const Vec3&) { return {-1e3, 1e3}; }
  template <class T>
  static Range usual_range(const T&) {
    return {};
  }
};

/// A number in a struct, together with the name of its element and its range.
struct NamedNumber {
  const char* name;       ///< name of the element
  double* value;          ///< pointer to the number, which is in SI units
  double low, high;       ///< bounds of the allowed range, inclusive, in the unit of the file
  double factor = 1;      ///< SI value / value in the file
  bool parameter = true;  ///< false: the number does not influence a run (option kShown)

  /// Returns the value in the unit of the file.
  double written() const { return *value / factor; }
};
/// Returns the numbers that `describe` visits directly, without those inside child elements. The
/// returned pointers refer to the object that `describe` describes.
std::vector<NamedNumber> numbers_of(const std::function<void(Fields&)>& describe);
/// Returns the name that distinguishes the object of `describe` in its list: the field `name`;
/// without one the first name of another object; otherwise an empty text.
std::string name_of(const std::function<void(Fields&)>& describe);

}  // namespace navvy::scene
