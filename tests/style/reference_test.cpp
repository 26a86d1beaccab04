// SPDX-License-Identifier: Apache-2.0
// Checks references: [docs/FILE.md, HEADING] must match a heading, [Name YEAR] an entry of
// docs/bibliography.md. No reference leads to a document outside the repository.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "style/sources.h"

namespace navvy::style {
namespace {

using Names = std::set<std::string>;

/// Targets of references: headings of each page of docs/ in lower case, and the keys of the
/// bibliography.
struct Targets {
  std::map<std::string, Names> headings;
  Names entries;
};

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// Adds a page: its headings of any level, and entries of the form "- **[Name YEAR]**".
void read_page(const SourceFile& page, Targets& targets) {
  static const std::regex heading(R"(^#+ +(.*?) *$)"), entry(R"(^- \*\*\[([^\]]+)\]\*\*.*$)");
  std::istringstream lines(page.text);
  std::string line;
  bool code = false;  // a fenced block may hold lines that begin with #
  Names& headings = targets.headings[page.path];
  while (std::getline(lines, line)) {
    if (line.compare(0, 3, "```") == 0) code = !code;
    std::smatch match;
    if (!code && std::regex_match(line, match, heading)) headings.insert(lower(match[1]));
    if (page.path == "docs/bibliography.md" && std::regex_match(line, match, entry))
      targets.entries.insert(match[1]);
  }
}

const Targets& targets() {
  static const Targets shared = [] {
    Targets out;
    for (const SourceFile& page : sources("docs", {".md"})) read_page(page, out);
    return out;
  }();
  return shared;
}

/// Documents that only their writers had, by their former names; some count only before a number.
struct Absent {
  const char* name;
  bool numbered;
};
constexpr Absent kAbsent[] = {{"SOIL_SOLVER", false},
                              {"VALIDATION", true},
                              {"MACHINES_AND_SENSORS", false},
                              {"PLANNER_FORMATS", false},
                              {"LIBRARY_NOTES", false},
                              {"thin-tools", false},
                              {"evidence/", false},
                              {"[evidence", false},
                              {"columns-and-particles", false},
                              {"STYLE:", false},
                              {"issue", true},
                              {"issues", true},
                              {"Issue", true}};

/// Returns the first of them that `line` names; null if none.
const char* absent_in(const std::string& line) {
  for (const Absent& absent : kAbsent)
    for (std::size_t at = line.find(absent.name); at != std::string::npos;
         at = line.find(absent.name, at + 1)) {
      const std::size_t end = at + std::strlen(absent.name);
      const bool number =
          end + 1 < line.size() && line[end] == ' ' && std::isdigit(line[end + 1]) != 0;
      if (number || !absent.numbered) return absent.name;
    }
  return nullptr;
}

/// Returns the wrong references of one line. A reference must not be broken over lines.
std::vector<std::string> wrong_references(const std::string& line, const Targets& targets) {
  // A page, and the text from the comma to the bracket; without a bracket the reference continues
  // beyond the line.
  static const std::regex page(R"re(\[(docs/[\w./-]+\.md)(?:, *([^\]]*))?(\]|$))re");
  static const std::regex literature(
      R"re(\[([A-Z][\w'-]+(?: (?:and|&) [A-Z][\w'-]+)*),? ((?:17|18|19|20)\d\d)[,:;\]])re");
  std::vector<std::string> found;
  if (const char* absent = absent_in(line))
    found.push_back(std::string(absent) + " leads out of the repository");
  if (line.find('[') == std::string::npos)
    return found;  // the expressions are slow and most lines have no reference
  for (std::sregex_iterator it(line.begin(), line.end(), page), end; it != end; ++it) {
    const std::string name = (*it)[1], heading = lower((*it)[2]);
    const auto at = targets.headings.find(name);
    if (at == targets.headings.end())
      found.push_back("no page " + name);
    else if ((*it)[3].length() == 0)
      found.push_back("a reference must be on one line: " + it->str());
    else if ((*it)[2].matched && at->second.count(heading) == 0)
      found.push_back(name + " has no heading '" + heading + "'");
  }
  // The first name and the year are the key; "et al." would hide a missing entry.
  if (line.find(" et al.") != std::string::npos)
    found.push_back("a reference is [Name YEAR], without et al.");
  for (std::sregex_iterator it(line.begin(), line.end(), literature), end; it != end; ++it) {
    const std::string key = (*it)[1].str() + " " + (*it)[2].str();
    if (targets.entries.count(key) == 0)
      found.push_back("docs/bibliography.md has no [" + key + "]");
  }
  return found;
}

std::vector<std::string> check(const SourceFile& file) {
  std::vector<std::string> found;
  std::istringstream lines(file.text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number)
    for (const std::string& wrong : wrong_references(line, targets()))
      found.push_back(file.path + ":" + std::to_string(number) + ": " + wrong);
  return found;
}

TEST(References, LeadToAHeadingOrAnEntryOfTheBibliography) {
  ASSERT_FALSE(targets().entries.empty()) << "docs/bibliography.md was not found";
  std::vector<std::string> found;
  for (const char* folder : {"src", "kernels", "tests", "bench", "docs", "terrain", "vehicles",
                             "scenarios", "examples", "cmake"})
    for (const SourceFile& file : sources(folder, {".h", ".cpp", ".cl", ".cmake", "CMakeLists.txt",
                                                   ".md", ".py", ".sdf", ".csv"})) {
      // This file contains the banned names.
      if (file.path == "tests/style/reference_test.cpp") continue;
      const std::vector<std::string> more = check(file);
      found.insert(found.end(), more.begin(), more.end());
    }
  for (const char* name : {"README.md", "CHANGELOG.md", "dev"}) {
    const std::vector<std::string> more = check(read_source(name));
    found.insert(found.end(), more.begin(), more.end());
  }
  EXPECT_EQ(report(found), "");
}

TEST(References, WithoutATargetAreFound) {
  Targets small;
  read_page({"docs/soil.md", "# Soil\n\n## Swell, and heaps\n```\n# no heading\n```\n"}, small);
  read_page({"docs/bibliography.md", "- **[Klar 2016]** G. Klar.\n"}, small);
  const auto wrong = [&](const std::string& line) { return wrong_references(line, small).size(); };
  EXPECT_EQ(wrong("x = 1;  // [docs/soil.md, soil] and [Klar 2016], [Klar 2016, section 3], "
                  "a[Index 4], [1 2016]"),
            0u);
  EXPECT_EQ(
      wrong("[docs/soil.md, swell, and Heaps]; see [the page](docs/soil.md) or [docs/soil.md]"),
      0u);
  EXPECT_EQ(wrong("[docs/soil.md, yield]"), 1u);
  EXPECT_EQ(wrong("[docs/soil.md, no heading]"), 1u);
  EXPECT_EQ(wrong("[docs/rock.md, soil]"), 1u);
  EXPECT_EQ(wrong("// [docs/soil.md, swell,"), 1u);
  EXPECT_EQ(wrong("[Klar 2017] [Hu and Fang 2018] [Jiang 2015: APIC]"), 3u);
  EXPECT_EQ(wrong("[Klar et al. 2016]"), 1u);
  for (const char* absent : {"SOIL_SOLVER 3", "[VALIDATION 1]", "MACHINES_AND_SENSORS",
                             "thin-tools.md", "evidence/forces", "[evidence, section 4]",
                             "columns-and-particles", "issue 2", "see issues 3"})
    EXPECT_EQ(wrong(absent), 1u) << absent;
  EXPECT_EQ(wrong("there is no evidence of an issue here, nor of validation"), 0u);
}

/// Returns the names of all tests as "Suite.Case".
Names test_cases() {
  static const std::regex declared(R"re(\bTEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\))re");
  Names out;
  for (const SourceFile& file : sources("tests", {".cpp"}))
    for (std::sregex_iterator it(file.text.begin(), file.text.end(), declared), end; it != end;
         ++it)
      out.insert((*it)[1].str() + "." + (*it)[2].str());
  return out;
}

TEST(References, OfTunedConstantsNameAnExistingTest) {
  // "tuned: Suite.Case"; other words after the colon describe how a constant was chosen.
  static const std::regex tuned(R"re(tuned: ([A-Z]\w*\.[A-Z]\w*))re");
  const Names known = test_cases();
  ASSERT_GT(known.size(), 100u);
  std::vector<std::string> found;
  for (const char* folder : {"src", "kernels"})
    for (const SourceFile& file : sources(folder, {".h", ".cpp", ".cl"}))
      for (std::sregex_iterator it(file.text.begin(), file.text.end(), tuned), end; it != end; ++it)
        if (known.count((*it)[1]) == 0) found.push_back(file.path + ": no test " + (*it)[1].str());
  EXPECT_EQ(report(found), "");
}

TEST(References, OfCiLeadToFilesAndTests) {
  static const std::regex path(R"(\b(?:tests|bench|cmake|src)/[\w./]+)");
  const std::string run = read_source(".ci/run").text;
  ASSERT_FALSE(run.empty());
  for (std::sregex_iterator it(run.begin(), run.end(), path), end; it != end; ++it)
    EXPECT_TRUE(exists((*it)[0])) << ".ci/run names " << (*it)[0];
}

TEST(References, OfTheBibliographyAreUnique) {
  Names seen;
  static const std::regex entry(R"(- \*\*\[([^\]]+)\]\*\*)");
  const std::string text = read_source("docs/bibliography.md").text;
  for (std::sregex_iterator it(text.begin(), text.end(), entry), end; it != end; ++it)
    EXPECT_TRUE(seen.insert((*it)[1]).second) << (*it)[1];
}

}  // namespace
}  // namespace navvy::style
