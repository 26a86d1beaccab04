// SPDX-License-Identifier: Apache-2.0
#include "lab/parameter.h"

#include <charconv>
#include <cmath>
#include <cstdio>

#include "core/error.h"

namespace navvy::lab {
namespace {

/// Returns the words of the choices as in a sentence: "plane or round", "a, b or c".
std::string joined(const std::vector<Choice>& choices) {
  std::string out;
  for (std::size_t i = 0; i < choices.size(); ++i)
    out += (i == 0 ? "" : i + 1 == choices.size() ? " or " : ", ") + choices[i].word;
  return out;
}

}  // namespace

bool ParameterRange::contains(double value) const {
  // Infinite limits alone would accept infinity.
  if (!std::isfinite(value) || (whole && value != std::round(value))) return false;
  const bool high_enough = open_least ? value > least : value >= least;
  const bool low_enough = open_most ? value < most : value <= most;
  return high_enough && low_enough;
}

std::string ParameterRange::text() const {
  const bool from = std::isfinite(least), to = std::isfinite(most);
  // A count is named first: most ranges are lengths.
  const std::string kind = whole ? "a whole number, " : "";
  // Both ends closed is the common case and has the shortest form; other cases are expressed in
  // words.
  if (from && to && !open_least && !open_most)
    return kind + short_text(least) + " .. " + short_text(most);
  std::string out;
  if (from) out = (open_least ? "above " : "at least ") + short_text(least);
  if (to)
    out +=
        (from ? " and " : "") + std::string(open_most ? "below " : "at most ") + short_text(most);
  if (out.empty()) return whole ? "a whole number" : "a finite number";
  return kind + out;
}

ParameterRange any() { return {}; }

// These five are all that rigs need; flags make a half-open range.
ParameterRange above(double least) {
  ParameterRange out;
  out.least = least;
  out.open_least = true;
  return out;
}

ParameterRange at_least(double least) {
  ParameterRange out;
  out.least = least;
  return out;
}

ParameterRange between(double least, double most) {
  ParameterRange out;
  out.least = least;
  out.most = most;
  return out;
}

ParameterRange count_from(int least) {
  ParameterRange out = at_least(least);
  out.whole = true;
  return out;
}

bool Parameter::allows(double wanted) const {
  // Choices are discrete numbers.
  if (choices.empty()) return range.contains(wanted);
  for (const Choice& choice : choices)
    if (choice.number == wanted) return true;
  return false;
}

std::string Parameter::rule() const {
  if (!choices.empty()) return joined(choices);
  // The unit completes the rule, so that an error is clear without the help.
  return range.text() + (unit.empty() ? "" : " " + unit);
}

std::string Parameter::text(double wanted) const {
  for (const Choice& choice : choices)
    if (choice.number == wanted) return choice.word;
  return short_text(wanted);
}

std::optional<double> Parameter::read(const std::string& written) const {
  for (const Choice& choice : choices)
    if (choice.word == written) return choice.number;
  // from_chars accepts no leading '+', which people write before angles and travels that may be
  // negative.
  const char* begin = written.data() + (written.rfind('+', 0) == 0 ? 1 : 0);
  const char* end = written.data() + written.size();
  double number = 0;
  const auto [stop, failed] = std::from_chars(begin, end, number);
  if (failed != std::errc() || stop != end) return std::nullopt;
  return number;
}

Parameter choice(const std::string& name, const std::string& word, const std::string& help,
                 const std::vector<Choice>& choices) {
  // The default is given by its word, so that no rig depends on the order of its choices.
  Parameter out{name, 0, "", help, any(), choices};
  for (const Choice& one : choices) {
    if (one.word != word) continue;
    out.value = one.number;
    return out;
  }
  throw InputError(Fault{Fault::Severity::kError, "", 0, name, word, out.rule(),
                         "the default must be a choice"});
}

Parameter yes_no(const std::string& name, bool value, const std::string& yes,
                 const std::string& no) {
  // Stored as 1 and 0 in the setup and in result files.
  return choice(name, value ? "yes" : "no", "", {{"yes", 1, yes}, {"no", 0, no}});
}

std::string short_text(double value) {
  char buffer[32];
  // Five digits are more than any rig resolves, and every value fits into a column.
  std::snprintf(buffer, sizeof buffer, "%.5g", value);
  return buffer;
}

}  // namespace navvy::lab
