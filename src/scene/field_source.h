// SPDX-License-Identifier: Apache-2.0
// Where a thing of the scene gets its values from: the children of one element, seen without any
// file format.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/math.h"

namespace navvy::scene {

/// Closed range of a value as written in the file (before conversion).
struct Range {
  double min = -std::numeric_limits<double>::max();
  double max = std::numeric_limits<double>::max();
};
/// Factor from degrees to SI.
inline constexpr double kDegree = kPi / 180.0;

/// One element of a scene file to whoever knows what belongs into it, so that a reader can stand
/// with the thing it reads, in a module that knows no file format.
///
/// Nothing here throws: faults are collected with file, line and element, and a target keeps its
/// value where its child is missing or faulty. Every child, and every attribute, has to be asked
/// for by name before `finish`, which reports the rest: nothing is skipped in silence.
class FieldSource {
 public:
  virtual ~FieldSource() = default;

  /// A number within `range`, times `factor` to SI.
  virtual FieldSource& number(const char* name, double& out, Range range, double factor = 1) = 0;
  /// A whole number within `range`.
  virtual FieldSource& whole(const char* name, int& out, Range range) = 0;
  /// Must not be empty.
  virtual FieldSource& text(const char* name, std::string& out) = 0;
  /// Two numbers, both within `range`.
  virtual FieldSource& vec2(const char* name, Vec2& out, Range range) = 0;
  /// Any number of numbers within `range`, times `factor`.
  virtual FieldSource& list(const char* name, std::vector<double>& out, Range range,
                            double factor = 1) = 0;
  /// Children that may occur any number of times, each with fields of its own, in file order.
  virtual FieldSource& each(const char* name, const std::function<void(FieldSource&)>& read) = 0;
  /// The child must be there.
  virtual FieldSource& required(const char* name) = 0;
  /// An attribute of the element itself; empty where there is none.
  virtual FieldSource& attribute(const char* name, std::string& out) = 0;
  /// Reports what was not asked for, and what occurs twice.
  virtual void finish() = 0;

  /// Whether there is such a child, sound or not.
  virtual bool has(const char* name) const = 0;
  /// The text of a child as it was written; empty where there is none.
  virtual std::string written(const char* name) const = 0;
  /// Reports an error of the child `name`; of the element itself where that is "" or not there.
  virtual void error(const char* name, const std::string& value, const std::string& rule,
                     const std::string& remedy = "") = 0;
};

}  // namespace navvy::scene
