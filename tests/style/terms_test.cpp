// SPDX-License-Identifier: Apache-2.0
// Language of the project: terms of docs/glossary.md, doc comments with a subject, and unique names
// of classes and headers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "style/sources.h"

namespace navvy::style {
namespace {

/// A word that the glossary replaces, as a pattern that matches whole words of any case.
struct Term {
  const char* pattern;
  const char* instead;
  std::vector<std::string> allowed;  ///< folders or files in which the word has its plain meaning
};

const std::vector<Term>& terms() {
  static const std::vector<Term> table = {
      {"told|tells?", "report, state, command, distinguish", {}},
      {"awake|asleep|woken", "active, inactive, activated", {"src/vehicle", "tests/vehicle"}},
      {"belts?", "track", {}},
      {"seats?|seated", "resting contact", {}},
      {"crumbs?", "loose particle", {}},
      {"cages?", "differential carrier", {}},
      {"known miss(es)?", "known deviation", {}},
      {"to the bit|same bits", "bit-identical", {}},
      {"headway", "progress", {}},
      {"workplace", "operator context", {}},
      {"bystanders?", "uncontrolled machine", {}},
      {"last words", "crash summary", {}},
      {"lips?", "cutting edge", {}},
      {"booked|booking|bookings", "recorded, deposited", {}},
      {"rooms?", "clearance, capacity, space", {}},
      {"mend(s|ed)?", "fix, correct", {}},
      {"borne|bears?", "support, carry", {}},
      {"kept slip", "prescribed slip", {}},
  };
  return table;
}

bool allowed(const Term& term, const SourceFile& file) {
  for (const std::string& place : term.allowed)
    if (file.path == place || file.under(place)) return true;
  return false;
}

/// Returns the text with its code blanked out: comments and the contents of string literals remain.
/// The result of `code_only` is the complement, and both preserve every line.
std::string words_only(const std::string& text) {
  std::string words = text;
  const std::string code = code_only(text);
  for (std::size_t i = 0; i < words.size() && i < code.size(); ++i)
    if (words[i] != '\n' && code[i] == text[i] && code[i] != ' ') words[i] = ' ';
  return words;
}

/// "path:line: 'word'; use ..." for each banned word of a text.
void find_terms(const SourceFile& file, const std::string& words, std::vector<std::string>& found) {
  for (const Term& term : terms()) {
    if (allowed(term, file)) continue;
    const std::regex pattern(std::string("\\b(") + term.pattern + ")\\b",
                             std::regex::icase | std::regex::optimize);
    for (std::sregex_iterator it(words.begin(), words.end(), pattern), end; it != end; ++it) {
      const long line = 1 + std::count(words.begin(), words.begin() + it->position(), '\n');
      found.push_back(file.path + ":" + std::to_string(line) + ": '" + it->str() + "'; use " +
                      term.instead);
    }
  }
}

std::vector<SourceFile> code_files() {
  std::vector<SourceFile> files;
  for (const char* folder : {"src", "kernels"})
    for (SourceFile& file : sources(folder, {".h", ".cpp", ".cl"}))
      // The table of old names holds the words that it replaces.
      if (file.path != "src/core/renamed_names.cpp") files.push_back(std::move(file));
  return files;
}

TEST(Terms, ReplacedByTheGlossaryAreAbsentInCommentsAndMessages) {
  std::vector<std::string> found;
  for (const SourceFile& file : code_files()) find_terms(file, words_only(file.text), found);
  EXPECT_EQ(report(found), "") << found.size() << " places";
}

/// Returns the text without code spans, which quote names of elements, layers and options.
std::string without_code_spans(const std::string& text) {
  static const std::regex span("`[^`\n]+`", std::regex::optimize);
  return std::regex_replace(text, span, "");
}

TEST(Terms, ReplacedByTheGlossaryAreAbsentInPages) {
  std::vector<std::string> found;
  for (const char* folder : {"docs", "scenarios", "terrain", "vehicles", "src", "kernels", "bench"})
    for (const SourceFile& file : sources(folder, {".md"}))
      if (!file.ends_with("glossary.md")) find_terms(file, without_code_spans(file.text), found);
  for (const char* page : {"README.md", "CONTRIBUTING.md"}) {
    const SourceFile file = read_source(page);
    find_terms(file, without_code_spans(file.text), found);
  }
  EXPECT_EQ(report(found), "") << found.size() << " places";
}

TEST(Terms, BannedOnesAreFoundInCommentsAndTextsAndNotInCode) {
  const SourceFile file{"src/x.cpp",
                        "// It is told where to go.\n"
                        "int room = 1;\n"
                        "const char* text = \"a crumb\";\n"
                        "// It is reported.\n"};
  std::vector<std::string> found;
  find_terms(file, words_only(file.text), found);
  EXPECT_EQ(report(found), report({"src/x.cpp:1: 'told'; use report, state, command, distinguish",
                                   "src/x.cpp:3: 'crumb'; use loose particle"}));
}

/// Returns true for first words of a doc comment that leave its subject out.
bool lacks_subject(const std::string& word) {
  static const std::set<std::string> words = {
      "of",  "what",   "whether",  "where",   "as",   "by",  "at",    "from", "how",  "in",
      "for", "beside", "likewise", "nothing", "none", "who", "which", "that", "when", "also"};
  std::string lower;
  for (const char c : word) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return words.count(lower) > 0;
}

/// Returns the line numbers of doc comments (`///` paragraphs) that begin without a subject.
std::vector<int> comments_without_subject(const std::string& text) {
  static const std::regex first("^\\s*///\\s+([A-Za-z]+).*");
  std::vector<int> lines;
  std::istringstream in(text);
  std::string line;
  bool inside = false;
  for (int number = 1; std::getline(in, line); ++number) {
    std::smatch match;
    const bool doc = std::regex_match(line, match, first);
    if (doc && !inside && lacks_subject(match[1])) lines.push_back(number);
    inside =
        line.find("///") != std::string::npos && line.find_first_not_of(' ') == line.find("///");
  }
  return lines;
}

TEST(DocComments, BeginWithAVerbOrTheNameOfTheThing) {
  std::vector<std::string> found;
  for (const SourceFile& file : sources("src", {".h"}))
    for (const int line : comments_without_subject(file.text))
      found.push_back(file.path + ":" + std::to_string(line));
  EXPECT_EQ(report(found), "") << found.size() << " doc comments begin without a subject";
}

TEST(DocComments, WithoutASubjectAreFound) {
  EXPECT_EQ(comments_without_subject("/// Whether it moves.\nbool moves();\n\n/// Returns it.\n/// "
                                     "Of the second line.\nint it();\n  /// Where it is.\n"),
            (std::vector<int>{1, 7}));
}

TEST(Names, OfHeadersAreUnique) {
  std::map<std::string, std::vector<std::string>> paths;
  for (const char* folder : {"src", "kernels"})
    for (const SourceFile& file : sources(folder, {".h"}))
      paths[file.path.substr(file.path.rfind('/') + 1)].push_back(file.path);
  std::vector<std::string> found;
  for (const auto& [name, where] : paths)
    if (where.size() > 1) found.push_back(name + ": " + where[0] + ", " + where[1]);
  EXPECT_EQ(report(found), "");
}

/// Classes, structs and enums that a header defines at the outermost level of its namespace.
std::set<std::string> defined_classes(const std::string& text) {
  static const std::regex definition(
      "^(?:struct|class|enum "
      "class|enum)\\s+(?:alignas\\([^)]*\\)\\s*)?([A-Z]\\w*)(?!\\w|::)[^;(]*\\{");
  std::set<std::string> names;
  const std::string code = code_only(text);
  std::istringstream in(code);
  for (std::string line; std::getline(in, line);) {
    std::smatch match;
    if (std::regex_search(line, match, definition)) names.insert(match[1]);
  }
  return names;
}

TEST(Names, OfClassesAreUnique) {
  std::map<std::string, std::vector<std::string>> paths;
  for (const SourceFile& file : sources("src", {".h"}))
    for (const std::string& name : defined_classes(file.text)) paths[name].push_back(file.path);
  std::vector<std::string> found;
  for (const auto& [name, where] : paths)
    if (where.size() > 1) found.push_back(name + ": " + where[0] + ", " + where[1]);
  EXPECT_EQ(report(found), "");
}

}  // namespace
}  // namespace navvy::style
