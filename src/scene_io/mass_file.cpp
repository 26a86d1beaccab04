// SPDX-License-Identifier: Apache-2.0
#include "scene_io/mass_file.h"

#include <algorithm>
#include <sstream>

#include "core/edit_distance.h"
#include "core/error.h"
#include "core/file.h"
#include "scene/fields.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

namespace {

/// Bounds of the mass of a link, as in SDF [kg].
constexpr double kLeast = 1e-6, kMost = 1e8;

[[noreturn]] void refuse(const std::string& file, int line, const std::string& element,
                         const std::string& value, const std::string& rule,
                         const std::string& remedy) {
  throw InputError(Fault{Fault::Severity::kError, file, line, element, value, rule, remedy});
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

}  // namespace

std::map<std::string, double> read_masses(const std::string& file,
                                          const std::vector<std::string>& links) {
  const std::vector<char> bytes = read_file(file);
  std::istringstream lines(std::string(bytes.begin(), bytes.end()));
  std::map<std::string, double> out;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    line = trimmed(line);
    if (line.empty() || line[0] == '#' || line == "link,mass_kg") continue;
    const std::size_t comma = line.rfind(',');
    if (comma == std::string::npos)
      refuse(file, number, "line", line, "must be the name of a link, a comma and a mass in kg",
             "e.g. boom,1350");
    const std::string link = trimmed(line.substr(0, comma)), text = trimmed(line.substr(comma + 1));
    if (std::find(links.begin(), links.end(), link) == links.end())
      refuse(file, number, "link", link, "the machine has no link of this name",
             suggestion(link, links));
    double mass = 0;
    // The comparison is false for NaN.
    if (!to_number(text, mass) || !(mass >= kLeast && mass <= kMost))
      refuse(
          file, number, "mass_kg", text,
          "must be a number from " + scene::short_text(kLeast) + " to " + scene::short_text(kMost),
          "give it in kg");
    if (!out.emplace(link, mass).second)
      refuse(file, number, "link", link, "has a mass already", "remove one of the two lines");
  }
  return out;
}

}  // namespace navvy::scene_io
