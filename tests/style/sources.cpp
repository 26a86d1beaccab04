// SPDX-License-Identifier: Apache-2.0
#include "style/sources.h"
#include "paths.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

namespace navvy::style {
namespace fs = std::filesystem;

bool SourceFile::ends_with(const std::string& suffix) const {
  return path.size() >= suffix.size() &&
         path.compare(path.size() - suffix.size(), suffix.size(), suffix) == 0;
}

bool SourceFile::under(const std::string& folder) const {
  return path.compare(0, folder.size() + 1, folder + "/") == 0;
}

std::string SourceFile::extension() const { return fs::path(path).extension(); }

std::vector<SourceFile> sources(const std::string& folder,
                                const std::vector<std::string>& endings) {
  std::vector<SourceFile> files;
  const fs::path root(navvy::source_dir());
  if (!fs::exists(root / folder)) return files;
  for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
    if (!entry.is_regular_file()) continue;
    SourceFile file;
    file.path = entry.path().lexically_relative(root).generic_string();
    const auto matches = [&](const std::string& ending) { return file.ends_with(ending); };
    if (std::none_of(endings.begin(), endings.end(), matches)) continue;
    std::ifstream stream(entry.path(), std::ios::binary);
    file.text.assign(std::istreambuf_iterator<char>(stream), {});
    files.push_back(std::move(file));
  }
  std::sort(files.begin(), files.end(),
            [](const auto& a, const auto& b) { return a.path < b.path; });
  return files;
}

SourceFile read_source(const std::string& path) {
  std::ifstream stream(fs::path(navvy::source_dir()) / path, std::ios::binary);
  return {path, std::string(std::istreambuf_iterator<char>(stream), {})};
}

bool exists(const std::string& path) { return fs::exists(fs::path(navvy::source_dir()) / path); }

std::vector<Include> includes(const std::string& text) {
  static const std::regex include(R"re(^\s*#\s*include\s*([<"])([^>"]+)[>"].*$)re");
  static const std::regex opening(R"(^\s*#\s*if.*$)"), closing(R"(^\s*#\s*endif.*$)");
  std::vector<Include> found;
  std::istringstream lines(text);
  std::string line;
  int depth = 0;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (line.find('#') == std::string::npos) continue;
    std::smatch match;
    if (std::regex_match(line, opening)) ++depth;
    if (std::regex_match(line, closing)) --depth;
    if (std::regex_match(line, match, include))
      found.push_back({match[2], match[1] == "<", number, depth});
  }
  return found;
}

std::string code_only(const std::string& text) {
  enum class In { kCode, kLine, kBlock, kString, kChar } in = In::kCode;
  std::string out = text;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const char next = i + 1 < text.size() ? text[i + 1] : '\0';
    const bool was_code = in == In::kCode;
    const bool digit_separator =
        i > 0 && std::isalnum(static_cast<unsigned char>(text[i - 1])) != 0;
    if (was_code) {
      if (c == '/' && next == '/') in = In::kLine;
      if (c == '/' && next == '*') in = In::kBlock;
      if (c == '"') in = In::kString;
      if (c == '\'' && !digit_separator) in = In::kChar;
      if (in != In::kCode && c == '/') out[i] = ' ';
      continue;
    }
    if (c != '\n') out[i] = ' ';
    if (in == In::kLine && c == '\n') in = In::kCode;
    if (in == In::kBlock && c == '/' && text[i - 1] == '*') in = In::kCode;
    if ((in == In::kString || in == In::kChar) && c == '\\') {
      if (next != '\n' && i + 1 < text.size()) out[++i] = ' ';
      continue;
    }
    if (in == In::kString && c == '"') in = In::kCode;
    if (in == In::kChar && c == '\'') in = In::kCode;
  }
  return out;
}

int count_lines(const std::string& text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n')) +
         (!text.empty() && text.back() != '\n');
}

std::vector<int> lines_with_word(const std::string& code, const std::string& word) {
  const auto is_word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
  };
  std::vector<int> lines;
  for (std::size_t at = code.find(word); at != std::string::npos; at = code.find(word, at + 1)) {
    if (at > 0 && is_word(code[at - 1])) continue;
    if (at + word.size() < code.size() && is_word(word.back()) && is_word(code[at + word.size()]))
      continue;
    lines.push_back(1 + static_cast<int>(std::count(
                            code.begin(), code.begin() + static_cast<std::ptrdiff_t>(at), '\n')));
  }
  return lines;
}

std::string report(const std::vector<std::string>& messages) {
  std::string out;
  for (const std::string& message : messages) out += message + "\n";
  return out;
}

}  // namespace navvy::style
