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
      {"awake|asleep|woken|wakes?|waking|woke",
       "active, inactive, activate",
       // Rigid bodies sleep and wake; a map layer is also found by its old name.
       {"src/vehicle", "tests/vehicle", "tests/map/map_maker_test.cpp"}},
      {"belts?", "track", {}},
      {"seats?|seated", "resting contact", {}},
      {"crumbs?", "loose particle", {}},
      {"cages?", "differential carrier", {}},
      {"known miss|known misses", "known deviation", {}},
      {"to the bit|same bits", "bit-identical", {}},
      {"headway", "progress", {}},
      {"workplace", "operator context", {}},
      {"bystanders?", "uncontrolled machine", {}},
      {"last words", "crash summary", {}},
      {"lips?", "cutting edge", {}},
      {"booked|booking|bookings|books?", "account, ledger, recorded, deposited", {}},
      {"rooms?", "clearance, capacity, space", {}},
      {"mend(s|ed)?", "fix, correct", {}},
      {"borne|bears?", "support, carry", {}},
      {"kept slip", "prescribed slip", {}},
      {"footings?",
       "support area, footprint",
       // Strip footings of the laboratory and of foundation engineering.
       {"src/lab", "tests/lab", "tests/validation", "docs/validation.md",
        "docs/validation_summary.md", "docs/reference/laboratory.md",
        "docs/reference/commands.md"}},
      {"gates?",
       "tolerance",
       // A hopper has a slide gate; the option of the rig `blade` is also read by its old name.
       {"src/lab/rigs/blade.cpp", "tests/soil/tools/hopper_device_test.cpp", "docs/validation.md"}},
      {"figures?",
       "results, measurements, values",
       // matplotlib calls a plot so.
       {"bench/plot.py", "docs/map_pictures.py"}},
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

/// Returns the terms whose pattern matches the whole of `word`, in lower case.
const std::vector<const Term*>& terms_of(const std::string& word) {
  // Few words are different, so each is compared with the patterns once.
  static std::map<std::string, std::vector<const Term*>> known;
  const auto [at, fresh] = known.try_emplace(word);
  if (fresh)
    for (const Term& term : terms())
      if (std::regex_match(word, std::regex(term.pattern))) at->second.push_back(&term);
  return at->second;
}

bool in_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Appends "path:line: 'word'; use ..." for the word or phrase at `from`, if a term replaces it.
void find_term(const SourceFile& file, const std::string& text, std::size_t from, std::size_t end,
               std::vector<std::string>& found) {
  std::string word = text.substr(from, end - from);
  for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const Term* term : terms_of(word)) {
    if (allowed(*term, file)) continue;
    const auto at = text.begin() + static_cast<std::ptrdiff_t>(from);
    const long line = 1 + std::count(text.begin(), at, '\n');
    found.push_back(file.path + ":" + std::to_string(line) + ": '" + text.substr(from, end - from) +
                    "'; use " + term->instead);
  }
}

/// Appends "path:line: 'word'; use ..." for each replaced word of a text, and each replaced phrase
/// of two or three words.
void find_terms(const SourceFile& file, const std::string& words, std::vector<std::string>& found) {
  static const std::regex phrase(
      "known misses|known miss|to the bit|same bits|last words|kept slip",
      std::regex::icase | std::regex::optimize);
  for (std::size_t i = 0; i < words.size();) {
    if (!in_word(words[i])) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < words.size() && in_word(words[end])) ++end;
    find_term(file, words, i, end, found);
    std::cmatch match;
    // Phrases begin with one of these letters.
    if (std::string("kKtTsSlL").find(words[i]) != std::string::npos &&
        std::regex_search(words.data() + i, words.data() + words.size(), match, phrase,
                          std::regex_constants::match_continuous)) {
      const std::size_t after = i + static_cast<std::size_t>(match.length());
      if (after == words.size() || !in_word(words[after])) find_term(file, words, i, after, found);
    }
    i = end;
  }
}

std::vector<SourceFile> code_files() {
  std::vector<SourceFile> files;
  for (const char* folder : {"src", "kernels", "tests", "bench", "examples"})
    for (SourceFile& file : sources(folder, {".h", ".cpp", ".cl"}))
      // The table of old names and this test hold the words that they replace.
      if (file.path != "src/core/renamed_names.cpp" && file.path != "tests/style/terms_test.cpp")
        files.push_back(std::move(file));
  return files;
}

TEST(Terms, ReplacedByTheGlossaryAreAbsentInCommentsAndMessages) {
  std::vector<std::string> found;
  for (const SourceFile& file : code_files()) find_terms(file, words_only(file.text), found);
  EXPECT_EQ(report(found), "") << found.size() << " places";
}

TEST(Terms, ReplacedByTheGlossaryAreAbsentInScripts) {
  std::vector<std::string> found;
  // Names in the code of a script count as well, as whole words.
  for (const char* folder : {"tools", "bench", "tests", "docs", "examples"})
    for (const SourceFile& file : sources(folder, {".py"})) find_terms(file, file.text, found);
  EXPECT_EQ(report(found), "") << found.size() << " places";
}

/// Returns the words of an identifier in lower case: "kWokenBlocks" and "woken_blocks" are both
/// "woken" and "blocks".
std::vector<std::string> words_of(const std::string& identifier) {
  std::vector<std::string> words;
  bool fresh = true;
  for (std::size_t i = 0; i < identifier.size(); ++i) {
    const auto at = [&](std::size_t k) { return static_cast<unsigned char>(identifier[k]); };
    if (identifier[i] == '_' || std::isdigit(at(i)) != 0) {
      fresh = true;
      continue;
    }
    // A capital begins a word unless it continues an abbreviation: "SDFGate" is "sdf" and "gate".
    const bool lower_before = i > 0 && std::islower(at(i - 1)) != 0;
    const bool lower_behind = i + 1 < identifier.size() && std::islower(at(i + 1)) != 0;
    if (fresh || (std::isupper(at(i)) != 0 && (lower_before || lower_behind))) words.emplace_back();
    fresh = false;
    words.back() += static_cast<char>(std::tolower(at(i)));
  }
  return words;
}

/// "path:line: 'identifier'; use ..." for each identifier with a word that a term replaces in code,
/// too. Words such as "tell" and "room" are common in identifiers and remain.
void find_identifiers(const SourceFile& file, std::vector<std::string>& found) {
  static const std::set<std::string> common = {"tell", "told",   "tells", "room", "rooms",
                                               "mend", "mended", "bear",  "bears"};
  const std::string code = code_only(file.text);
  for (std::size_t i = 0; i < code.size();) {
    std::size_t end = i;
    while (end < code.size() && in_word(code[end])) ++end;
    const std::string name = code.substr(i, end - i);
    i = end + 1;
    for (const std::string& word : words_of(name))
      for (const Term* term : terms_of(word)) {
        if (common.count(word) > 0 || allowed(*term, file)) continue;
        const auto at = code.begin() + static_cast<std::ptrdiff_t>(end);
        const long line = 1 + std::count(code.begin(), at, '\n');
        found.push_back(file.path + ":" + std::to_string(line) + ": '" + name + "'; use " +
                        term->instead);
      }
  }
}

TEST(Terms, ReplacedByTheGlossaryAreAbsentInIdentifiers) {
  std::vector<std::string> found;
  for (const SourceFile& file : code_files()) find_identifiers(file, found);
  EXPECT_EQ(report(found), "") << found.size() << " places";
}

TEST(Terms, BannedOnesAreFoundInsideIdentifiers) {
  EXPECT_EQ(words_of("kSDFGateWidth2_m"),
            (std::vector<std::string>{"k", "sdf", "gate", "width", "m"}));
  std::vector<std::string> found;
  find_identifiers({"src/x.cpp", "int wokenBlocks;\nint gates_;\nint navigate; // a gate\n"},
                   found);
  EXPECT_EQ(report(found), report({"src/x.cpp:1: 'wokenBlocks'; use active, inactive, activate",
                                   "src/x.cpp:2: 'gates_'; use tolerance"}));
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
