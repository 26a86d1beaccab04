// SPDX-License-Identifier: Apache-2.0
// Parameters of a rig's geometry and procedure, each with its range.
//
// A parameter is declared once, in its rig. The command line, `check` (lab/rig.h) and the help text
// all follow from that declaration.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace navvy::lab {

/// Range of a parameter. Only finite numbers lie in any range.
struct ParameterRange {
  /// Lower end.
  double least = -std::numeric_limits<double>::infinity();
  /// Upper end.
  double most = std::numeric_limits<double>::infinity();
  /// `least` itself is excluded.
  bool open_least = false;
  /// `most` itself is excluded.
  bool open_most = false;
  /// Whole numbers only: a count.
  bool whole = false;

  /// Returns true if the value is allowed.
  bool contains(double value) const;
  /// Returns the rule in words, "above 0" or "15 .. 150"; "a finite number" without limits.
  std::string text() const;
};

/// Returns the range of all finite numbers.
ParameterRange any();
/// Returns value > least: for divisors, and sizes of bodies.
ParameterRange above(double least);
/// Returns value >= least: for quantities that may be left out.
ParameterRange at_least(double least);
/// Returns least <= value <= most.
ParameterRange between(double least, double most);
/// Returns the whole numbers from `least` on.
ParameterRange count_from(int least);

/// One of the variants of a rig.
struct Choice {
  /// Text on the command line.
  std::string word;
  /// Value in the setup; the command line accepts it, too.
  double number = 0;
  std::string help;
};

/// One number of a rig, not of its soil. SI units unless `unit` says otherwise.
struct Parameter {
  /// Text on the command line, words joined by '-'.
  std::string name;
  /// Default.
  double value = 0;
  /// "" for a pure number; may be a length of the rig's own, as "cells" or "depths".
  std::string unit;
  /// Description that continues the name: `depth` "of the pit".
  std::string help;
  /// Unused when there are choices.
  ParameterRange range;
  /// Empty for a number.
  std::vector<Choice> choices = {};
  /// Former name, which the command line reads with a warning for one release; "" without one.
  std::string former = {};

  /// Returns true if the value is in the range, or one of the choices.
  bool allows(double value) const;
  /// Returns the allowed values for help and errors: "above 0 m", "plane or round".
  std::string rule() const;
  /// Returns a value for display: the word of a choice, else the number.
  std::string text(double value) const;
  /// Returns the number that `written` stands for, a word of the choices or a number, allowed or
  /// not. Empty for any other text.
  std::optional<double> read(const std::string& written) const;
};

/// Returns a parameter that is one of `choices`; the default is the choice of that word.
/// @throws InputError when no choice has the word.
Parameter choice(const std::string& name, const std::string& word, const std::string& help,
                 const std::vector<Choice>& choices);
/// Returns a parameter that is yes (1) or no (0), with the meaning of each.
Parameter yes_no(const std::string& name, bool value, const std::string& yes,
                 const std::string& no);

/// Returns a number with at most five significant digits: "0.0625", "12000".
std::string short_text(double value);

}  // namespace navvy::lab
