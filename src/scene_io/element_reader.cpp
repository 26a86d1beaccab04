// SPDX-License-Identifier: Apache-2.0
#include "scene_io/element_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

namespace navvy::scene_io {

using scene::Field;
using scene::Mark;
using scene::Refers;

namespace {

/// Returns the rule that a number must follow, for messages. Six digits are enough for bounds,
/// which people have written; values are compared with the exact ones.
std::string range_text(const Range& range) {
  const double huge = std::numeric_limits<double>::max();
  // A range without bounds still excludes infinity and NaN.
  if (range.min == -huge && range.max == huge) return "a finite number";
  if (range.max == huge) return "a number of at least " + scene::short_text(range.min, 6);
  return "a number from " + scene::short_text(range.min, 6) + " to " +
         scene::short_text(range.max, 6);
}

// The search is linear: a list holds the few tens of names that one element allows.
bool contains(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

/// Warns of a value in degrees that is a common angle in radians to four digits, such as 0.7854.
/// Multiples of 15 deg up to a whole turn cover the angles that people write. At least three digits
/// behind the point are required, as 0.5 or 1.6 may well be degrees.
void warn_of_radians(const Element& element, double value, Faults& faults) {
  constexpr double kStep = kPi / 12;  // 15 deg
  const double steps = std::round(std::abs(value) / kStep);
  const std::string text = text_of(element);
  const std::size_t point = text.find('.');
  const bool digits = point != std::string::npos && text.size() - point > 3;
  if (!digits || steps < 1 || steps > 24 || std::abs(std::abs(value) - steps * kStep) > 5e-4)
    return;
  faults.warning(
      element, text,
      "is " + std::to_string(static_cast<int>(steps) * 15) + " deg in radians; were radians meant?",
      "this element is in degrees");
}

/// Reads the text of one element into the member behind a field. A faulty value leaves the member
/// unchanged, so that reading goes on and finds the other faults.
struct ValueReader {
  const Field& field;
  const Element& at;
  Faults& faults;
  double factor;

  bool numbers(std::size_t count, std::vector<double>& v) const {
    return read_numbers(at, count, field.range, v, faults);
  }
  void operator()(bool* out) const { read_flag(at, *out, faults); }
  void operator()(std::uint64_t* out) const { read_seed(at, *out, faults); }
  // A whole number passes through a double, so that one check of the range and one message serve
  // all numbers. Every int is exact in a double.
  void operator()(int* out) const {
    std::vector<double> v;
    if (!numbers(1, v)) return;
    // The range has bounded it, so the cast cannot overflow.
    if (v[0] == std::floor(v[0]))
      *out = static_cast<int>(v[0]);
    else
      faults.error(at, text_of(at), "must be a whole number");
  }
  // A faulty text leaves the member empty, as if the element were missing.
  void operator()(std::optional<int>* out) const {
    const std::size_t before = faults.error_count();
    int value = 0;
    (*this)(&value);
    if (faults.error_count() == before) *out = value;
  }
  void operator()(double* out) const {
    std::vector<double> v;
    if (!numbers(1, v)) return;
    // The range has been checked in the unit of the file; from here on the value is in SI units.
    *out = v[0] * factor;
    if (factor == kDegree) warn_of_radians(at, v[0], faults);
  }
  void operator()(std::string* out) const {
    *out = text_of(at);
    if (out->empty()) faults.error(at, "", "must not be empty");
  }
  // Vectors have no factor: every vector of a scene is in metres or without a unit.
  void operator()(Vec2* out) const {
    std::vector<double> v;
    if (numbers(2, v)) *out = Vec2(v[0], v[1]);
  }
  void operator()(Vec3* out) const {
    std::vector<double> v;
    if (numbers(3, v)) *out = Vec3(v[0], v[1], v[2]);
  }
  // An empty text is an empty list. Where a rule needs entries, as for gears, it reports that
  // itself.
  void operator()(std::vector<double>* out) const {
    std::vector<double> v;
    if (!numbers(0, v)) return;
    for (double& value : v) value *= factor;
    *out = std::move(v);
  }
  // Each element appends one point; `field` visits all elements of the name.
  void operator()(std::vector<Vec3>* out) const {
    std::vector<double> v;
    if (numbers(3, v)) out->emplace_back(v[0], v[1], v[2]);
  }
  void operator()(const scene::Direction& out) const {
    std::vector<double> v;
    if (!numbers(3, v)) return;
    const Vec3 read(v[0], v[1], v[2]);
    if (read.norm() > 1e-6)
      *out.value = read.normalized();
    else
      faults.error(at, text_of(at), "a direction must not be zero");
  }
  // The words are counted here, so that the message names the order of the components.
  void operator()(const scene::Rgb& out) const {
    std::vector<double> v;
    if (words_of(text_of(at)).size() != 3)
      faults.error(at, text_of(at), "must be 3 numbers from 0 to 1: red green blue");
    else if (numbers(3, v))
      for (std::size_t i = 0; i < 3; ++i) out.value[i] = static_cast<float>(v[i]);
  }
  // The rule lists all names, so no nearest one is searched.
  void operator()(const scene::NamedChoice& out) const {
    const std::string value = text_of(at);
    std::string rule = "must be one of";
    for (std::size_t i = 0; i < out.names.size(); ++i) {
      if (out.names[i] == value) return out.set(i);
      rule += std::string(" ") + out.names[i];
    }
    faults.error(at, value, rule);
  }
  // Only sensors have poses that are read here; libsdformat reads the others.
  void operator()(Pose* out) const { read_pose(at, *out, faults); }
  // Derived values have no element.
  void operator()(Mat3*) const {}
  void operator()(const scene::Computed&) const {}
};

}  // namespace

// The names come from the XML and not from the machine: after any fault of the model, libsdformat
// makes no links, and references are checked all the same.
Names Names::of_model(const Element& model) {
  Names names;
  for (const Element* e = model.FirstChildElement(); e; e = e->NextSiblingElement()) {
    const std::string kind = e->Name(), name = attribute(*e, "name");
    if (kind == "link") names.links.push_back(name);
    if (kind == "frame") names.frames.push_back(name);
    if (kind == "navvy:shell") names.shells.push_back(name);
    if (kind == "joint") {
      names.joints.push_back(name);
      names.joint_type[name] = attribute(*e, "type");
    }
  }
  return names;
}

Element* ElementReader::take(const Mark& mark, const char* name) {
  // SDF elements of a model have been checked by `check_sdf` and read by libsdformat.
  if (mixed_ && std::string_view(name).rfind("navvy:", 0) != 0) return nullptr;
  // A name counts as known even if it is absent: `finish` suggests it.
  known_.push_back(name);
  Element* child = element_.FirstChildElement(name);
  if (child == nullptr && mark.has(Mark::kNeeded))
    faults_.error(element_, "", std::string("needs an element <") + name + ">", "add it");
  if (child != nullptr && mark.given != nullptr) *mark.given = true;
  return child;
}

void ElementReader::read_attribute(const Field& field) {
  attributes_.push_back(field.name);
  // Attributes of an SDF element, such as its name, come from libsdformat.
  if (mixed_) return;
  std::string& out = *std::get<std::string*>(field.value);
  if (element_.Attribute(field.name) != nullptr) out = scene_io::attribute(element_, field.name);
  if (field.mark.has(Mark::kNeeded) && out.empty())
    faults_.error(element_, "", std::string("needs an attribute ") + field.name + "=\"...\"",
                  field.text);
}

void ElementReader::read_value_attribute(const Element& child,
                                         const scene::ValueAttribute& attribute) {
  attributed_.push_back(child.Name());
  const std::vector<std::string> names(attribute.choice.names.begin(),
                                       attribute.choice.names.end());
  // Without the attribute, and after a fault in it, the first choice holds: it is the default.
  std::size_t index = 0;
  for (const auto* at = child.FirstAttribute(); at; at = at->Next()) {
    if (std::string_view(at->Name()) != attribute.name) {
      faults_.error(child, at->Name(), "unknown attribute",
                    faults_.nearest(at->Name(), {attribute.name}));
      continue;
    }
    const auto found = std::find(names.begin(), names.end(), at->Value());
    index = static_cast<std::size_t>(found - names.begin());
    if (found != names.end()) continue;
    // The remedy is the nearest name, or lists all.
    faults_.error(child, at->Value(), std::string("unknown ") + attribute.name,
                  faults_.nearest(at->Value(), names));
    index = 0;
  }
  attribute.choice.set(index);
}

void ElementReader::field(const Field& field) {
  if (field.mark.has(Mark::kDerived)) return;
  if (field.mark.has(Mark::kAttribute)) return read_attribute(field);
  Element* child = take(field.mark, field.name);
  if (child == nullptr) return;
  // `finish` is not called for mixed elements, so what it would report of this child is reported
  // here.
  if (mixed_ && child->FirstChildElement() != nullptr) {
    faults_.error(*child, child->FirstChildElement()->Name(), "must hold a value, not elements",
                  field.text);
    return;
  }
  // The form of the angles is given by attributes, which the reader of poses knows.
  if (std::holds_alternative<Pose*>(field.value)) attributed_.emplace_back(field.name);
  const double factor = scene::unit_of(field.name).factor;
  // Only points may repeat: a track has one <roller_m> for each roller.
  const bool repeats = std::holds_alternative<std::vector<Vec3>*>(field.value);
  if (repeats) {
    repeatable_.push_back(field.name);
    points_.push_back(field.name);
  }
  for (; child != nullptr; child = repeats ? child->NextSiblingElement(field.name) : nullptr)
    std::visit(ValueReader{field, *child, faults_, factor}, field.value);
  // The loop has left `child` at null. A value with an attribute or a reference does not repeat, so
  // the first element is the one that was read.
  if (field.attribute)
    read_value_attribute(*element_.FirstChildElement(field.name), *field.attribute);
  if (field.refers != Refers::kNothing)
    check_reference(*element_.FirstChildElement(field.name), *std::get<std::string*>(field.value),
                    field.refers);
}

void ElementReader::check_reference(const Element& child, const std::string& name, Refers refers) {
  // An empty name has been reported by the reader of the text.
  if (names_ == nullptr || name.empty()) return;
  switch (refers) {
    case Refers::kLink:
      require_name(child, name, "link of this name in the model", names_->links, faults_);
      break;
    case Refers::kJoint:
      require_name(child, name, "joint of this name in the model", names_->joints, faults_);
      break;
    case Refers::kShell:
      require_name(child, name, "navvy:shell of this name in the model", names_->shells, faults_);
      break;
    case Refers::kSoil:
      // A suggestion needs candidates, and a world without soils has none.
      if (names_->soils.empty())
        faults_.error(child, name, "no soil of this name in the world",
                      "add <navvy:soil ref=\"" + name + "\"/>");
      else
        require_name(child, name, "soil of this name in the world", names_->soils, faults_);
      break;
    // Hitches are read after the machines; program_order.cpp checks their names.
    default:
      break;
  }
}

void ElementReader::read_inside(Element& child,
                                const std::function<void(scene::Fields&)>& describe) {
  // Known names and attributes belong to one element, so each has a reader of its own.
  ElementReader inner(child, names_, faults_);
  describe(inner);
  inner.finish();
}

void ElementReader::group(const scene::Group& group,
                          const std::function<void(scene::Fields&)>& describe) {
  nested_.push_back(group.name);
  Element* child = take(group.mark, group.name);
  // `take` has noted the name, so that `finish` accepts an element whose own reader comes later.
  if (child == nullptr || group.mark.has(Mark::kOwnReader)) return;
  if (group.make) group.make();
  read_inside(*child, describe);
}

void ElementReader::list(const scene::List& list) {
  if (list.mark.has(Mark::kDerived)) return;
  if (mixed_ && list.mark.has(Mark::kSdf)) {
    // libsdformat has made the items; only what is in navvy: is read here.
    for (std::size_t i = 0; i < list.size; ++i) {
      const std::string name = scene::name_of([&](scene::Fields& f) { list.item(i, f); });
      const Element* child = named_child(element_, list.kinds[0].name, name);
      if (child == nullptr) continue;
      ElementReader inner(const_cast<Element&>(*child), names_, faults_, true);
      list.item(i, inner);
    }
    return;
  }
  bool any = false;
  // A needed list is missing only if no kind of item is there, so no kind is needed by itself.
  for (const scene::List::Kind& kind : list.kinds) {
    repeatable_.emplace_back(kind.name);
    any = take({}, kind.name) != nullptr || any;
  }
  if (!any && list.mark.has(Mark::kNeeded)) take(list.mark, list.kinds[0].name);
  if (!any) return;
  // In the order of the file, whatever the kinds.
  for (Element* child = element_.FirstChildElement(); child; child = child->NextSiblingElement())
    for (std::size_t kind = 0; kind < list.kinds.size(); ++kind)
      if (std::string_view(list.kinds[kind].name) == child->Name())
        read_inside(*child, [&](scene::Fields& inner) { list.add(kind, inner); });
}

void ElementReader::types(const scene::Types& types) {
  attributes_.emplace_back(types.attribute);
  const std::string type = scene_io::attribute(element_, types.attribute);
  // A missing attribute stands for the first type.
  std::size_t index = 0;
  while (index < types.names.size() && !type.empty() && types.names[index] != type) ++index;
  if (index == types.names.size()) {
    faults_.error(element_, type, std::string("unknown ") + types.attribute,
                  faults_.nearest(type, {types.names.begin(), types.names.end()}));
    // Without a type nothing is known of the children, so none of them is reported.
    for (const Element* e = element_.FirstChildElement(); e; e = e->NextSiblingElement()) {
      known_.emplace_back(e->Name());
      repeatable_.emplace_back(e->Name());
    }
    return;
  }
  // The object is replaced before its fields are read, as fields belong to the type.
  types.choose(index);
  types.describe(index, *this);
}

void ElementReader::finish() {
  std::set<std::string> seen;
  for (const Element* child = element_.FirstChildElement(); child;
       child = child->NextSiblingElement()) {
    const std::string name = child->Name();
    const bool repeats = contains(repeatable_, name);
    if (!contains(known_, name)) {
      faults_.error(*child, text_of(*child), "unknown element", faults_.nearest(name, known_));
      continue;
    }
    // The first one was read, so the second one is reported.
    if (!repeats && !seen.insert(name).second)
      faults_.error(*child, text_of(*child), "must occur only once", "remove one of them");
    // Children with fields and items of lists have readers of their own; repeated points have none.
    if ((repeats && !contains(points_, name)) || contains(nested_, name)) continue;
    if (child->FirstChildElement())
      faults_.error(*child, child->FirstChildElement()->Name(), "must hold a value, not elements");
    if (child->FirstAttribute() && !contains(attributed_, name))
      faults_.error(*child, child->FirstAttribute()->Name(), "takes no attributes");
  }
  for (const auto* at = element_.FirstAttribute(); at; at = at->Next())
    if (!contains(attributes_, at->Name()))
      faults_.error(element_, at->Name(), "unknown attribute",
                    faults_.nearest(at->Name(), attributes_));
  if (!text_of(element_).empty() && !known_.empty())
    faults_.error(element_, text_of(element_), "text is not allowed between the elements here",
                  "remove it");
}

const Element& child_or_self(const Element& element, const char* name) {
  const Element* child = element.FirstChildElement(name);
  return child != nullptr ? *child : element;
}

// The order is that of the file: rules take the i-th element as that of the i-th item of a list,
// which `ElementReader::list` fills in the same order.
std::vector<Element*> children_of(Element& parent, std::initializer_list<const char*> names) {
  std::vector<Element*> out;
  for (Element* e = parent.FirstChildElement(); e; e = e->NextSiblingElement())
    for (const char* name : names)
      if (std::string_view(name) == e->Name()) out.push_back(e);
  return out;
}

void add_missing(Element& to, const Element& from) {
  for (const Element* child = from.FirstChildElement(); child;
       child = child->NextSiblingElement()) {
    Element* own = to.FirstChildElement(child->Name());
    if (own == nullptr)
      Document::append_copy(to, *child);
    else if (child->FirstChildElement() != nullptr)
      add_missing(*own, *child);
  }
}

bool require_name(const Element& at, const std::string& name, const std::string& what,
                  const std::vector<std::string>& names, Faults& faults) {
  if (contains(names, name)) return true;
  faults.error(at, name, "no " + what, faults.nearest(name, names));
  return false;
}

bool read_numbers(const Element& element, std::size_t count, Range range, std::vector<double>& out,
                  Faults& faults) {
  // Words of the text, so that line breaks and several blanks count as one.
  const std::vector<std::string> words = words_of(text_of(element));
  if (count > 0 && words.size() != count) {
    faults.error(element, text_of(element),
                 count == 1 ? "must be " + range_text(range)
                            : "must be " + std::to_string(count) + " numbers separated by blanks");
    return false;
  }
  out.clear();
  for (const std::string& word : words) {
    // One fault per element is enough to find it. The comparison refuses NaN and infinity, which
    // are numbers to a parser.
    double value = 0;
    if (!to_number(word, value) || !std::isfinite(value) || value < range.min ||
        value > range.max) {
      faults.error(element, word, "must be " + range_text(range));
      return false;
    }
    out.push_back(value);
  }
  return true;
}

bool read_flag(const Element& element, bool& out, Faults& faults) {
  // These are the four spellings of SDF.
  const std::string value = text_of(element);
  if (value != "true" && value != "1" && value != "false" && value != "0") {
    faults.error(element, value, "must be true or false");
    return false;
  }
  out = is_true(value);
  return true;
}

bool read_seed(const Element& element, std::uint64_t& out, Faults& faults) {
  const std::string text = text_of(element);
  // Not by way of a double, which holds only 53 bits of a seed.
  const auto result = std::from_chars(text.data(), text.data() + text.size(), out);
  if (!text.empty() && result.ec == std::errc() && result.ptr == text.data() + text.size())
    return true;
  faults.error(element, text, "must be a whole number from 0 to 18446744073709551615");
  return false;
}

bool read_pose(const Element& element, Pose& out, Faults& faults) {
  const bool quaternion = attribute(element, "rotation_format") == "quat_xyzw";
  std::vector<double> v;
  // 1e7 m is beyond any site; snapshots have the same bound (limits::kFarthest).
  if (!read_numbers(element, quaternion ? 7 : 6, {-1e7, 1e7}, v, faults)) return false;
  if (quaternion) {
    // SDF writes w last, Eigen takes it first.
    Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
    // A norm far from one is a mistake, not rounding.
    if (std::abs(q.norm() - 1) > 1e-3) {
      faults.error(element, text_of(element),
                   "the last four numbers must be a unit quaternion x y z w");
      return false;
    }
    out = Pose::Identity();
    out.linear() = q.normalized().toRotationMatrix();
    out.translation() = Vec3(v[0], v[1], v[2]);
    return true;
  }
  // The attribute counts for the angles only.
  const double f = is_true(attribute(element, "degrees")) ? kDegree : 1;
  out = make_pose(v[0], v[1], v[2], v[3] * f, v[4] * f, v[5] * f);
  return true;
}

}  // namespace navvy::scene_io
