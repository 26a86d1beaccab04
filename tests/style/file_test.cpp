// SPDX-License-Identifier: Apache-2.0
// Form of files: licence line, length, bans in libraries, kernel rules (kernels/README.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "style/sources.h"

namespace navvy::style {
namespace {

std::vector<SourceFile> all_sources() {
  std::vector<SourceFile> files;
  for (const char* folder : {"src", "kernels", "tests", "bench", "examples", "cmake"}) {
    for (SourceFile& file : sources(folder, {".h", ".cpp", ".cl", ".cmake", "CMakeLists.txt"})) {
      files.push_back(std::move(file));
    }
  }
  return files;
}

TEST(Files, BeginWithTheLicenceLine) {
  std::vector<std::string> found;
  for (const SourceFile& file : all_sources()) {
    const bool cmake = file.ends_with(".cmake") || file.ends_with("CMakeLists.txt");
    const std::string line =
        std::string(cmake ? "# " : "// ") + "SPDX-License-Identifier: Apache-2.0\n";
    if (file.text.compare(0, line.size(), line) != 0) found.push_back(file.path);
  }
  EXPECT_EQ(report(found), "");
}

TEST(Files, StayWithinTheirLength) {
  std::vector<std::string> found;
  for (const SourceFile& file : all_sources()) {
    const int most = file.extension() == ".cl" ? 200 : 600;
    const int lines = count_lines(file.text);
    if (lines > most)
      found.push_back(file.path + ": " + std::to_string(lines) + " lines, at most " +
                      std::to_string(most));
  }
  EXPECT_EQ(report(found), "");
}

TEST(Files, HaveNoLineBeyondTheColumnLimit) {
  constexpr std::size_t kWidest = 100;  // as clang-format wraps C++
  std::vector<std::string> found;
  for (const char* folder : {"src", "kernels", "tests", "bench", "examples"}) {
    for (const SourceFile& file : sources(folder, {".h", ".cpp", ".cl"})) {
      std::istringstream lines(file.text);
      std::string line;
      bool raw = false;
      for (int number = 1; std::getline(lines, line); ++number) {
        // An #include cannot be broken; a message to users, or a text in a raw string, may stay in
        // one piece.
        const bool inside = raw || line.find('"') != std::string::npos;
        const std::size_t opened = line.rfind("R\"("), closed = line.rfind(")\"");
        if (opened != std::string::npos && (closed == std::string::npos || closed < opened))
          raw = true;
        else if (closed != std::string::npos)
          raw = false;
        if (line.size() <= kWidest || inside) continue;
        found.push_back(file.path + ":" + std::to_string(number) + ": " +
                        std::to_string(line.size()) + " characters");
      }
    }
  }
  EXPECT_EQ(report(found), "");
}

TEST(Files, OfScriptsHaveNoLineBeyondTheColumnLimit) {
  constexpr std::size_t kWidest = 100;
  std::vector<std::string> found;
  for (const char* folder : {"tools", "bench", "tests", "docs", "examples"})
    for (const SourceFile& file : sources(folder, {".py"})) {
      std::istringstream lines(file.text);
      std::string line;
      for (int number = 1; std::getline(lines, line); ++number)
        if (line.size() > kWidest)
          found.push_back(file.path + ":" + std::to_string(number) + ": " +
                          std::to_string(line.size()) + " characters");
    }
  EXPECT_EQ(report(found), "");
}

/// Words that `folder`'s files must not use, each with the reason.
struct Ban {
  const char* word;
  const char* reason;
};

std::vector<std::string> banned(const SourceFile& file, const std::vector<Ban>& bans) {
  std::vector<std::string> found;
  const std::string code = code_only(file.text);
  for (const Ban& ban : bans) {
    for (int line : lines_with_word(code, ban.word)) {
      found.push_back(file.path + ":" + std::to_string(line) + ": " + ban.word + ": " + ban.reason);
    }
  }
  return found;
}

TEST(Libraries, NeitherPrintNorExitNorUseUnrepeatableRandomNumbers) {
  const std::vector<Ban> bans = {
      {"std::cout", "libraries never print: use core/log.h"},
      {"std::cerr", "libraries never print: use core/log.h"},
      {"printf(", "libraries never print: use core/log.h"},
      {"std::printf(", "libraries never print: use core/log.h"},
      {"fprintf(", "libraries never print: use core/log.h"},
      {"puts(", "libraries never print: use core/log.h"},
      {"exit(", "libraries never exit: throw"},
      {"abort(", "libraries never exit: throw"},
      {"rand(", "not repeatable: use core/random.h"},
      {"srand(", "not repeatable: use core/random.h"},
      {"random_device", "not repeatable: use core/random.h"},
      {"mt19937", "its distributions differ between platforms: use core/random.h"},
  };
  std::vector<std::string> found;
  for (const SourceFile& file : sources("src", {".h", ".cpp"})) {
    if (file.under("src/cli")) continue;
    const std::vector<std::string> more = banned(file, bans);
    found.insert(found.end(), more.begin(), more.end());
  }
  EXPECT_EQ(report(found), "");
}

TEST(Libraries, BansApplyToCodeAndNotToComments) {
  const std::vector<Ban> bans = {{"exit(", "no"}, {"double", "no"}};
  EXPECT_EQ(
      banned(SourceFile{"a", "// exit(1)\n\"exit(2)\"; /* exit(3)\n */ my_exit(4); double_x;\n"},
             bans)
          .size(),
      0u);
  EXPECT_EQ(report(banned(SourceFile{"a", "int x;\n  std::exit(1); double y;\n"}, bans)),
            "a:2: exit(: no\na:2: double: no\n");
}

/// Returns true if the first include of `name`, or of the file it includes first, and so on, is
/// common/portable.h.
bool begins_portable(const std::string& name) {
  if (name == "common/portable.h") return true;
  for (const SourceFile& file : sources("kernels", {".h"})) {
    if (file.path != "kernels/" + name) continue;
    const std::vector<Include> inner = includes(file.text);
    return !inner.empty() && inner.front().name != name && begins_portable(inner.front().name);
  }
  return false;
}

/// The text with the lines that only the host compiles (`#ifdef __cplusplus`) blanked out.
std::string device_part(std::string text) {
  const std::string begin = "#ifdef __cplusplus", end = "#endif";
  for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at + 1)) {
    const std::size_t stop = std::min(text.find(end, at), text.size());
    for (std::size_t i = at + begin.size(); i < stop; ++i)
      if (text[i] != '\n') text[i] = ' ';
  }
  return text;
}

std::vector<std::string> check_kernel(const SourceFile& file) {
  static const std::vector<Ban> bans = {
      {"double", "optional in OpenCL: use float, or integers for exact sums"},
      {"half", "optional in OpenCL"},
      {"native_", "accuracy is the vendor's choice"},
      {"fast_length", "accuracy is the vendor's choice"},
      {"fast_normalize", "accuracy is the vendor's choice"},
      {"__NV_CL_C_VERSION", "vendor quirks live in src/device"},
      {"__AMD__", "vendor quirks live in src/device"},
      {"cl_nv_", "vendor quirks live in src/device"},
      {"cl_amd_", "vendor quirks live in src/device"},
      {"cl_intel_", "vendor quirks live in src/device"},
      {"FP_CONTRACT", "common/portable.h sets it for all"},
  };
  std::vector<std::string> found = banned(SourceFile{file.path, device_part(file.text)}, bans);
  // `native_` and the vendors' extensions are prefixes, so beginnings of words are searched, too.
  const std::string code = code_only(file.text);
  for (const char* prefix : {"native_", "cl_nv_", "cl_amd_", "cl_intel_"}) {
    if (code.find(prefix) != std::string::npos) found.push_back(file.path + ": uses " + prefix);
  }
  bool first = true;
  for (const Include& include : includes(file.text)) {
    const std::string where = file.path + ":" + std::to_string(include.line) + ": ";
    const bool header = file.extension() == ".h";
    if (!header && first && !begins_portable(include.name)) {
      found.push_back(where +
                      "the first include is not, or does not begin with, common/portable.h");
    }
    if (!include.angle && !exists("kernels/" + include.name))
      found.push_back(where + "no kernels/" + include.name);
    // A header's own guard is the only conditional allowed around an include; <...> is for the
    // host, inside another one.
    if (!include.angle && include.depth > (header ? 1 : 0))
      found.push_back(where + "include inside a conditional");
    if (include.angle && (!header || include.depth < 2))
      found.push_back(where + "<...> is for the host only");
    first = false;
  }
  if (file.extension() == ".cl" && first)
    found.push_back(file.path + ": does not include common/portable.h");
  return found;
}

TEST(Kernels, FollowTheRulesOfTheirReadme) {
  std::vector<std::string> found;
  const std::vector<SourceFile> files = sources("kernels", {".cl", ".h"});
  ASSERT_FALSE(files.empty());
  for (const SourceFile& file : files) {
    if (file.path == "kernels/common/portable.h") continue;
    const std::vector<std::string> more = check_kernel(file);
    found.insert(found.end(), more.begin(), more.end());
  }
  EXPECT_EQ(report(found), "");
}

TEST(Kernels, ViolationsOfRulesAreFound) {
  const auto violations = [](const std::string& path, const std::string& text) {
    return check_kernel(SourceFile{path, text}).size();
  };
  const std::string first = "#include \"common/portable.h\"\n";
  EXPECT_EQ(
      violations("kernels/soil/a.cl", first + "kernel void f(global float* x) { x[0] = 1; }\n"),
      0u);
  EXPECT_EQ(violations("kernels/soil/a.cl", "kernel void f(global float* x) { x[0] = 1; }\n"), 1u);
  EXPECT_EQ(violations("kernels/soil/a.cl", first + "#include \"common/absent.h\"\n"), 1u);
  EXPECT_EQ(violations("kernels/soil/a.cl", first + "double x;\n"), 1u);
  EXPECT_EQ(
      violations("kernels/soil/a.cl", first + "#if X\n#include \"common/portable.h\"\n#endif\n"),
      1u);
  EXPECT_GE(violations("kernels/soil/a.cl", first + "x = native_sqrt(y);\n"), 1u);
}

}  // namespace
}  // namespace navvy::style
