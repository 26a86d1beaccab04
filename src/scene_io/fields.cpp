// SPDX-License-Identifier: Apache-2.0
#include "scene_io/fields.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <set>

namespace navvy::scene_io {

namespace {
// As a person would write it, not as it is stored.
std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

std::string range_text(const Range& range) {
  const double huge = std::numeric_limits<double>::max();
  // A range that bounds nothing still asks for a finite number.
  if (range.min == -huge && range.max == huge) return "a finite number";
  if (range.max == huge) return "a number of at least " + short_number(range.min);
  return "a number from " + short_number(range.min) + " to " + short_number(range.max);
}

bool contains(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}
}  // namespace

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
    // The first bad word is reported and the rest left alone: one fault an element is enough to
    // find it. Written so that NaN and infinities, which are numbers to a parser, are refused.
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
  // The four spellings of SDF and no others.
  const std::string value = text_of(element);
  if (value == "true" || value == "1") {
    out = true;
  } else if (value == "false" || value == "0") {
    out = false;
  } else {
    faults.error(element, value, "must be true or false");
    return false;
  }
  return true;
}

bool read_pose(const Element& element, Pose& out, Faults& faults) {
  const bool quaternion = attribute(element, "rotation_format") == "quat_xyzw";
  std::vector<double> v;
  if (!read_numbers(element, quaternion ? 7 : 6, {-1e7, 1e7}, v, faults)) return false;
  if (quaternion) {
    Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
    // Normalised below; a sum of squares far from one is a slip of the pen, not rounding.
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
  // Degrees are an attribute of SDF 1.9 and hold for the turn only.
  const std::string degrees = attribute(element, "degrees");
  const double f = degrees == "true" || degrees == "1" ? kDegree : 1;
  out = make_pose(v[0], v[1], v[2], v[3] * f, v[4] * f, v[5] * f);
  return true;
}

namespace {

/// Degrees that are a well-known angle in radians to four digits, such as 0.7854 or 1.571, are
/// likely radians.
void ask_about_radians(const Element& element, double value, Faults& faults) {
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
      "this element counts in degrees");
}

}  // namespace

Element* Fields::take(const char* name) {
  // Whatever is asked for counts as known, also when it is not there: the list serves `finish` and
  // suggestions.
  known_.push_back(name);
  return element_.FirstChildElement(name);
}

Fields& Fields::number(const char* name, double& out, Range range, double factor) {
  std::vector<double> v;
  // A value with a fault leaves the default in place, so reading goes on and finds the other
  // faults.
  if (Element* child = take(name); child && read_numbers(*child, 1, range, v, faults_)) {
    out = v[0] * factor;
    if (factor == kDegree) ask_about_radians(*child, v[0], faults_);
  }
  return *this;
}

Fields& Fields::number(const char* name, float& out, Range range) {
  double value = out;
  number(name, value, range);
  out = static_cast<float>(value);
  return *this;
}

Fields& Fields::whole(const char* name, int& out, Range range) {
  Element* child = take(name);
  if (!child) return *this;
  std::vector<double> v;
  if (!read_numbers(*child, 1, range, v, faults_)) return *this;
  // A range has bounded it, so the cast below cannot overflow.
  if (v[0] != std::floor(v[0])) {
    faults_.error(*child, text_of(*child), "must be a whole number");
  } else {
    out = static_cast<int>(v[0]);
  }
  return *this;
}

Fields& Fields::whole(const char* name, std::uint64_t& out) {
  Element* child = take(name);
  if (!child) return *this;
  const std::string text = text_of(*child);
  // Not by way of a double, which holds no more than 53 bits of a seed.
  const auto result = std::from_chars(text.data(), text.data() + text.size(), out);
  if (text.empty() || result.ec != std::errc() || result.ptr != text.data() + text.size())
    faults_.error(*child, text, "must be a whole number from 0 to 18446744073709551615");
  return *this;
}

Fields& Fields::text(const char* name, std::string& out) {
  if (Element* child = take(name)) {
    out = text_of(*child);
    if (out.empty()) faults_.error(*child, "", "must not be empty");
  }
  return *this;
}

Fields& Fields::flag(const char* name, bool& out) {
  if (Element* child = take(name)) read_flag(*child, out, faults_);
  return *this;
}

Fields& Fields::vec2(const char* name, Vec2& out, Range range) {
  std::vector<double> v;
  if (Element* child = take(name); child && read_numbers(*child, 2, range, v, faults_))
    out = Vec2(v[0], v[1]);
  return *this;
}

Fields& Fields::vec3(const char* name, Vec3& out, Range range) {
  std::vector<double> v;
  if (Element* child = take(name); child && read_numbers(*child, 3, range, v, faults_))
    out = Vec3(v[0], v[1], v[2]);
  return *this;
}

Fields& Fields::direction(const char* name, Vec3& out) {
  // An absent element leaves the default, which is a direction already.
  std::vector<double> v;
  Element* child = take(name);
  if (!child || !read_numbers(*child, 3, {-1e6, 1e6}, v, faults_)) return *this;
  const Vec3 read(v[0], v[1], v[2]);
  if (read.norm() > 1e-6)
    out = read.normalized();
  else
    faults_.error(*child, text_of(*child), "a direction must not be zero");
  return *this;
}

Fields& Fields::list(const char* name, std::vector<double>& out, Range range, double factor) {
  if (Element* child = take(name)) {
    read_numbers(*child, 0, range, out, faults_);
    for (double& value : out) value *= factor;
  }
  return *this;
}

Fields& Fields::each(const char* name, const std::function<void(Element&)>& read) {
  repeatable_.push_back(name);
  for (Element* child = take(name); child; child = child->NextSiblingElement(name)) read(*child);
  return *this;
}

Fields& Fields::nested(const char* name, const std::function<void(Element&)>& read) {
  nested_.push_back(name);
  if (Element* child = take(name)) read(*child);
  return *this;
}

Fields& Fields::required(const char* name) {
  if (!has(name))
    faults_.error(element_, "", std::string("needs an element <") + name + ">", "add it");
  return *this;
}

Fields& Fields::attribute(const char* name) {
  attributes_.push_back(name);
  return *this;
}

void Fields::one_of(const Element& child, const std::string& value,
                    const std::vector<std::string>& names) {
  if (contains(names, value)) return;
  std::string rule = "must be one of";
  for (const std::string& name : names) rule += " " + name;
  faults_.error(child, value, rule);
}

void Fields::finish() {
  std::set<std::string> seen;
  // One walk over the children that are there, against what the tables asked for.
  for (const Element* child = element_.FirstChildElement(); child;
       child = child->NextSiblingElement()) {
    const std::string name = child->Name();
    if (!contains(known_, name)) {
      faults_.error(*child, text_of(*child), "unknown element", faults_.nearest(name, known_));
      // The second one is blamed, as readers took the first.
    } else if (!contains(repeatable_, name) && !seen.insert(name).second) {
      faults_.error(*child, text_of(*child), "must occur only once", "remove one of them");
    }
    // Values hold text only; what holds elements is read by its own table.
    if (!contains(known_, name) || contains(repeatable_, name) || contains(nested_, name)) continue;
    if (child->FirstChildElement())
      faults_.error(*child, child->FirstChildElement()->Name(), "must hold a value, not elements");
    if (child->FirstAttribute())
      faults_.error(*child, child->FirstAttribute()->Name(), "takes no attributes");
  }
  for (const auto* at = element_.FirstAttribute(); at; at = at->Next())
    if (!contains(attributes_, at->Name()))
      faults_.error(element_, at->Name(), "unknown attribute",
                    faults_.nearest(at->Name(), attributes_));
  // A value's own text has been read; text between elements is mostly a forgotten tag.
  if (!text_of(element_).empty() && !known_.empty())
    faults_.error(element_, text_of(element_), "text is not allowed between the elements here",
                  "remove it");
}

}  // namespace navvy::scene_io
