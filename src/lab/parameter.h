// SPDX-License-Identifier: Apache-2.0
// The numbers that describe a rig's own geometry and procedure, each with what it may be.
//
// A parameter is declared once, where the rig is. What a person may write, what `check` (lab/rig.h)
// refuses and what the program's help says about it all come from that one declaration.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace navvy::lab {

/// The numbers a parameter may take. Only finite ones lie in any range.
struct ParameterRange {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool open_least = false;  ///< `least` itself is not allowed
  bool open_most = false;   ///< `most` itself is not allowed
  bool whole = false;       ///< whole numbers only: a count

  bool contains(double value) const;
  /// The rule in words, "above 0" or "15 .. 150"; "a finite number" when there is no limit.
  std::string text() const;
};

/// Any finite number.
ParameterRange any();
/// Value > least: what a rig divides by, or what would be no body at all.
ParameterRange above(double least);
ParameterRange at_least(double least);              ///< value >= least: what may be left out
ParameterRange between(double least, double most);  ///< both ends allowed
/// Whole numbers from `least` on.
ParameterRange count_from(int least);

/// One of the ways in which a rig can be run.
struct Choice {
  std::string word;   ///< as on the command line
  double number = 0;  ///< what the setup holds for it; accepted on the command line too
  std::string help;
};

/// One number of a rig; the soil is not among them. SI units unless `unit` says otherwise.
struct Parameter {
  std::string name;  ///< as on the command line, words joined by '-'
  double value = 0;  ///< default
  /// "" for a pure number; may be a length of the rig's own, as "cells" or "depths".
  std::string unit;
  std::string help;                  ///< what it is, continuing the name: `depth` "of the pit"
  ParameterRange range;              ///< unused when there are choices
  std::vector<Choice> choices = {};  ///< empty for a number

  bool allows(double value) const;
  /// What is allowed, for help and errors: "above 0 m", "plane or round".
  std::string rule() const;
  /// A value as a person reads it: the word of a choice, else the number.
  std::string text(double value) const;
  /// The number that `written` stands for: a word of the choices or a number, whether or not it is
  /// allowed. Empty for text that is neither.
  std::optional<double> read(const std::string& written) const;
};

/// A parameter that is one of `choices`; the default is the choice of that word.
/// @throws InputError when no choice has the word.
Parameter choice(const std::string& name, const std::string& word, const std::string& help,
                 const std::vector<Choice>& choices);
/// A parameter that is yes (1) or no (0), with what each means.
Parameter yes_no(const std::string& name, bool value, const std::string& yes,
                 const std::string& no);

/// A number in as few digits as tell it, at most five: "0.0625", "12000".
std::string short_text(double value);

}  // namespace navvy::lab
