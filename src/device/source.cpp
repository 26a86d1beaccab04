// SPDX-License-Identifier: Apache-2.0
#include "device/source.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <iomanip>
#include <set>
#include <sstream>
#include <string_view>

#include "core/file.h"
#include "core/hash.h"
#include "device/embedded_private.h"

namespace navvy::device {
namespace {

/// Returns the folder that replaces the embedded files; empty if there is none.
std::string replacing_folder() {
  const char* folder = std::getenv("NAVVY_KERNEL_DIR");
  return folder == nullptr ? "" : folder;
}

/// Returns the file that an include line names, or "" for any other line.
std::string_view included_path(std::string_view line) {
  std::size_t at = line.find_first_not_of(" \t");
  // Accepts blanks like a compiler does, so that no include that other tools accept is ignored.
  // Includes in angle brackets are not ours.
  if (at == std::string::npos || line[at] != '#') return "";
  at = line.find_first_not_of(" \t", at + 1);
  if (at == std::string::npos || line.compare(at, 7, "include") != 0) return "";
  const std::size_t open = line.find_first_not_of(" \t", at + 7);
  if (open == std::string::npos || line[open] != '"') return "";
  const std::size_t close = line.find('"', open + 1);
  return close == std::string::npos ? "" : line.substr(open + 1, close - open - 1);
}

bool is_pragma_once(std::string_view line) { return line.compare(0, 12, "#pragma once") == 0; }

/// Appends a file with its includes, depth first as a compiler reads it. Each file is included once
/// per program, so headers need no guards. Every world expands all programs to find those that are
/// built, so no line is copied but to `out`.
void expand(const std::string& path, std::string_view text, std::set<std::string>& seen,
            std::string& out) {
  seen.insert(path);
  out += "#line 1 \"" + path + "\"\n";
  // Line numbers are preserved, so that a build log refers to lines of the file.
  for (int number = 1; !text.empty(); ++number) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    const std::string child(included_path(line));
    if (child.empty()) {
      // The driver sees a single text, where "once" would only cause a warning.
      if (!is_pragma_once(line)) out += line;
      out += '\n';
      continue;
    }
    if (seen.count(child) == 0) {
      std::string child_text;
      try {
        child_text = kernel_source(child);
      } catch (const DeviceError& error) {
        throw DeviceError(path + ":" + std::to_string(number) + ": " + error.what());
      }
      expand(child, child_text, seen, out);
    }
    out += "#line " + std::to_string(number + 1) + " \"" + path + "\"\n";
  }
}

}  // namespace

std::string kernel_source(const std::string& path) {
  const std::string folder = replacing_folder();
  // Read anew at every call: edit a kernel and run again without a build.
  if (!folder.empty()) {
    try {
      const std::vector<char> text = read_file(folder + "/" + path);
      return std::string(text.begin(), text.end());
    } catch (const FileError& error) {
      throw DeviceError(std::string("kernel file: ") + error.what() +
                        " (the folder comes from the environment variable NAVVY_KERNEL_DIR)");
    }
  }
  // The list is short and a program asks for few files, so there is no map.
  for (const EmbeddedFile* file = embedded_files(); file->path != nullptr; ++file) {
    if (path == file->path) return file->text;
  }
  throw DeviceError("no kernel file '" + path +
                    "' was embedded by the build (it looks in kernels/)");
}

std::string expand_includes(const std::string& path, const std::string& text) {
  std::set<std::string> seen;
  std::string out;
  expand(path, text, seen, out);
  return out;
}

namespace {

/// Returns the place of line `number` of an expanded text as `file:line`; empty if there is none.
std::string place_of(const std::string& source, int number) {
  const std::string directive = "#line ";
  std::istringstream lines(source);
  std::string file, line;
  int next = 1;
  for (int i = 0; i < number; ++i, ++next) {
    if (!std::getline(lines, line)) return "";
    if (line.rfind(directive, 0) != 0) continue;
    // The directive numbers the line after it.
    std::istringstream words(line.substr(directive.size()));
    words >> next >> std::quoted(file);
    --next;
  }
  return file.empty() ? "" : file + ":" + std::to_string(next - 1);
}

}  // namespace

std::string with_files(const std::string& log, const std::string& source) {
  const std::string mark = "<kernel>:";
  std::string out;
  std::size_t from = 0;
  for (std::size_t at = log.find(mark); at != std::string::npos; at = log.find(mark, from)) {
    std::size_t end = at + mark.size();
    int number = 0;
    const auto [digits_end, error] =
        std::from_chars(log.data() + end, log.data() + log.size(), number);
    const std::string place = error == std::errc() ? place_of(source, number) : "";
    if (!place.empty()) end = static_cast<std::size_t>(digits_end - log.data());
    out += log.substr(from, at - from) + (place.empty() ? mark : place);
    from = end;
  }
  return out + log.substr(from);
}

KernelSources kernel_sources() {
  KernelSources out;
  out.folder = replacing_folder();
  StateHash hash;
  for (const EmbeddedFile* file = embedded_files(); file->path != nullptr; ++file) {
    const std::string_view path = file->path;
    std::string text;
    try {
      text = kernel_source(file->path);
    } catch (const DeviceError&) {
      // The folder lacks a file: a program that needs it says so when it is built.
    }
    if (text != file->text) out.changed.emplace_back(path);
    hash.bytes(path.data(), path.size());
    hash.bytes(text.data(), text.size());
  }
  out.hash = hash.hex();
  return out;
}

}  // namespace navvy::device
