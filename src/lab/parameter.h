// SPDX-License-Identifier: Apache-2.0
// Parameters of a rig's geometry and procedure, each with its allowed range.
//
// A rig declares each parameter once. The command line, the check of a setup (lab/rig.h) and the
// help text use that declaration.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace navvy::lab {

/// Allowed range of a parameter's values, in the parameter's unit. Infinity and NaN are never
/// allowed.
struct ParameterRange {
  /// Lower limit; minus infinity if there is none.
  double least = -std::numeric_limits<double>::infinity();
  /// Upper limit; infinity if there is none.
  double most = std::numeric_limits<double>::infinity();
  /// True if the value `least` itself is not allowed.
  bool open_least = false;
  /// True if the value `most` itself is not allowed.
  bool open_most = false;
  /// True if only whole numbers are allowed, as for a count.
  bool whole = false;

  /// Returns true if the range allows `value`.
  bool contains(double value) const;
  /// Returns the range in words: "above 0", "15 .. 150", or "a finite number" if there are no
  /// limits.
  std::string text() const;
};

/// Returns the range of all finite numbers.
ParameterRange any();
/// Returns the range of values above `least`, for divisors and sizes of bodies.
ParameterRange above(double least);
/// Returns the range of values from `least` upwards, for quantities that may be zero.
ParameterRange at_least(double least);
/// Returns the range from `least` to `most`, both included.
ParameterRange between(double least, double most);
/// Returns the range of whole numbers from `least` upwards.
ParameterRange count_from(int least);

/// One allowed value of a parameter that has a fixed list of values, such as "plane" or "round".
struct Choice {
  /// Word for the value on the command line.
  std::string word;
  /// Number that represents the value in Setup::geometry. The command line accepts it as well.
  double number = 0;
  /// Description of the value, for the help text.
  std::string help;
};

/// One parameter of a rig; soil values are not parameters. Its value is in SI units unless `unit`
/// names another unit.
struct Parameter {
  /// Parameter name on the command line: words joined by '-'.
  std::string name;
  /// Default value, in `unit`.
  double value = 0;
  /// Unit of the value as text; "" for a dimensionless number. May be a length of the rig itself,
  /// such as "cells" or "depths".
  std::string unit;
  /// Description that continues the parameter's name: for `depth`, "of the pit".
  std::string help;
  /// Allowed values. Ignored if `choices` is not empty.
  ParameterRange range;
  /// List of the allowed values; empty if the parameter may be any number in `range`.
  std::vector<Choice> choices = {};
  /// Former name of the parameter, which the command line accepts with a warning for one release;
  /// "" if it was never renamed.
  std::string former = {};

  /// Returns true if `value` is in `choices` or, without a list of allowed values, in `range`.
  bool allows(double value) const;
  /// Returns the allowed values in words, for the help text and error messages: "above 0 m", "plane
  /// or round".
  std::string rule() const;
  /// Returns `value` for display: its word if it is one of `choices`, otherwise the number.
  std::string text(double value) const;
  /// Returns the number that the text `written` stands for: the number of a word in `choices`, or
  /// the number that the text itself is. Does not check whether the number is allowed. Returns
  /// nothing for any other text.
  std::optional<double> read(const std::string& written) const;
};

/// Returns a parameter that has a fixed list of allowed values. `word` is the word of the default
/// value.
/// @throws InputError if `choices` does not contain `word`.
Parameter choice(const std::string& name, const std::string& word, const std::string& help,
                 const std::vector<Choice>& choices);
/// Returns a parameter whose allowed values are yes (1) and no (0). `value` is the default; the
/// texts `yes` and `no` describe the two values for the help.
Parameter yes_no(const std::string& name, bool value, const std::string& yes,
                 const std::string& no);

/// Returns the number as text with at most five significant digits: "0.0625", "12000".
std::string short_text(double value);

}  // namespace navvy::lab
