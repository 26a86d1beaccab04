// SPDX-License-Identifier: Apache-2.0
#include "core/printable.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/log.h"
#include "core/utf8.h"

namespace navvy {
namespace {

TEST(Printable, EscapesWhatATerminalWouldObeyOrHide) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", ""},
      {"plain text, C:\\x1B", "plain text, C:\\x1B"},
      {"Gr\u00FC\u00DFe \u571F \U0001F69C", "Gr\u00FC\u00DFe \u571F \U0001F69C"},
      {"\x1B[31mred", "\\x1B[31mred"},
      {"\x1B]0;title\x07", "\\x1B]0;title\\x07"},
      {std::string("a\0b", 3), "a\\x00b"},
      {"a\nb\tc\rd\x7F", "a\\x0Ab\\x09c\\x0Dd\\x7F"},
      {"\u009B31m", "\\u009B31m"},
      {"a\u202Ebdc\u202C", "a\\u202Ebdc\\u202C"},
      {"\u2066x\u2069\u200F\u061C", "\\u2066x\\u2069\\u200F\\u061C"},
      {"a\u2028b\u200Bc\uFEFF", "a\\u2028b\\u200Bc\\uFEFF"},
      {"\U000E0041", "\\uE0041"},
      // Latin-1, a truncated character, an overlong form, a surrogate, and a byte of no character.
      {"b\xFCro", "b\\xFCro"},
      {"\xE5\x9C", "\\xE5\\x9C"},
      {"\xC0\x9B", "\\xC0\\x9B"},
      {"\xED\xA0\x80", "\\xED\\xA0\\x80"},
      {"\xFF", "\\xFF"},
  };
  for (const auto& [text, expected] : cases) {
    EXPECT_EQ(printable(text), expected);
    EXPECT_EQ(printable(expected), expected) << "a second pass changes nothing";
  }
  EXPECT_EQ(printable_lines("a\n\tb\x1B\r\n"), "a\n\tb\\x1B\\x0D\n");
}

TEST(Printable, EveryPairOfBytesGivesWellFormedTextOfOneLine) {
  for (int a = 0; a < 256; ++a)
    for (int b = 0; b < 256; ++b) {
      const std::string text = printable(std::string{static_cast<char>(a), static_cast<char>(b)});
      ASSERT_EQ(first_bad_utf8(text), std::string::npos) << a << " " << b;
      for (const char c : text) ASSERT_GE(static_cast<unsigned char>(c), 0x20) << a << " " << b;
      ASSERT_EQ(text.find("\xC2\x9B"), std::string::npos) << a << " " << b;
    }
}

TEST(Printable, FaultsAndLogLinesAreOneLineEach) {
  const Fault fault{Fault::Severity::kError, "a\nb.sdf", 3, "x\x1B[2J", "\xFF", "no\u202E", "do\r"};
  EXPECT_EQ(fault.text(), "a\\x0Ab.sdf:3: error: x\\x1B[2J: '\\xFF': no\\u202E (do\\x0D)");
  EXPECT_EQ(std::string(InputError({fault, fault}).what()), fault.text() + "\n" + fault.text());
  std::string logged;
  set_log_sink([&](LogLevel, const std::string& line) { logged += line; });
  log_warning("file 'x\nerror: y\x1B[2J'");
  set_log_sink({});
  EXPECT_EQ(logged, "file 'x\\x0Aerror: y\\x1B[2J'");
}

}  // namespace
}  // namespace navvy
