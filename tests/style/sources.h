// SPDX-License-Identifier: Apache-2.0
// Text files of the repository, for the tests that read them.
#pragma once

#include <string>
#include <vector>

namespace navvy::style {

struct SourceFile {
  std::string path;  ///< relative to the repository, with '/'
  std::string text;
  bool ends_with(const std::string& suffix) const;
  bool under(const std::string& folder) const;  ///< folder without trailing '/'
  std::string extension() const;                ///< ".h"; empty when there is none
};

/// Returns every file below `folder` (relative to the repository) with one of these extensions or
/// names, sorted by path.
std::vector<SourceFile> sources(const std::string& folder, const std::vector<std::string>& endings);
/// Returns one file, with `path` relative to the repository; its text is empty if it does not
/// exist.
SourceFile read_source(const std::string& path);
bool exists(const std::string& path);

/// One `#include`: the name, angle brackets or quotes, line number, and depth of enclosing
/// conditionals (an include guard counts).
struct Include {
  std::string name;
  bool angle = false;
  int line = 0;
  int depth = 0;
};
std::vector<Include> includes(const std::string& text);

/// Returns `text` with comments and the contents of string literals blanked out; lines are
/// preserved.
std::string code_only(const std::string& text);
int count_lines(const std::string& text);

/// Returns the line numbers of `word` as a whole word.
std::vector<int> lines_with_word(const std::string& code, const std::string& word);

/// Joins messages, one per line, for EXPECT_EQ(report, "").
std::string report(const std::vector<std::string>& messages);

}  // namespace navvy::style
