// SPDX-License-Identifier: Apache-2.0
#include "core/printable.h"

#include <cstdint>
#include <cstdio>

#include "core/utf8.h"

namespace navvy {
namespace {

/// First and last code point of a range.
struct Range {
  std::uint32_t first, last;
};

/// Characters that act on a terminal or on the text around them, or that cannot be seen.
constexpr Range kEscaped[] = {
    {0x00, 0x1F},        // C0, with ESC
    {0x7F, 0x9F},        // DEL and C1
    {0xAD, 0xAD},        // soft hyphen
    {0x061C, 0x061C},    // Arabic letter mark
    {0x180E, 0x180E},    // Mongolian vowel separator
    {0x200B, 0x200F},    // zero width, direction marks
    {0x2028, 0x202E},    // line separators, embeddings and overrides of direction
    {0x2060, 0x206F},    // invisible operators, isolates of direction
    {0xFEFF, 0xFEFF},    // byte order mark
    {0xFFF9, 0xFFFB},    // interlinear annotation
    {0xE0000, 0xE0FFF},  // tags
};

bool is_escaped(std::uint32_t code) {
  for (const Range& range : kEscaped)
    if (code >= range.first && code <= range.last) return true;
  return false;
}

/// Length of the character with this first byte [bytes]; the text is well-formed.
std::size_t length_of(unsigned char lead) {
  return lead < 0x80 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
}

/// Returns the code point of a well-formed character.
std::uint32_t code_of(std::string_view character) {
  const auto lead = static_cast<unsigned char>(character[0]);
  if (character.size() == 1) return lead;
  // The lead byte of n bytes has n ones, a zero, and the highest bits.
  std::uint32_t code = lead & (0x7FU >> character.size());
  for (const char c : character.substr(1))
    code = code << 6 | (static_cast<unsigned char>(c) & 0x3F);
  return code;
}

void append_escape(std::string& out, std::uint32_t code, const char* format) {
  char text[16];
  std::snprintf(text, sizeof text, format, static_cast<unsigned>(code));
  out += text;
}

/// Appends well-formed UTF-8.
void append_good(std::string& out, std::string_view text, bool lines) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t size = length_of(static_cast<unsigned char>(text[at]));
    const std::string_view character = text.substr(at, size);
    const std::uint32_t code = code_of(character);
    at += size;
    if (!is_escaped(code) || (lines && (code == '\n' || code == '\t')))
      out += character;
    else
      append_escape(out, code, code < 0x80 ? "\\x%02X" : "\\u%04X");
  }
}

std::string cleaned(std::string_view text, bool lines) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::size_t bad = first_bad_utf8(text);
    append_good(out, text.substr(0, bad), lines);
    if (bad == std::string_view::npos) break;
    append_escape(out, static_cast<unsigned char>(text[bad]), "\\x%02X");
    text.remove_prefix(bad + 1);
  }
  return out;
}

}  // namespace

std::string printable(std::string_view text) { return cleaned(text, false); }
std::string printable_lines(std::string_view text) { return cleaned(text, true); }

}  // namespace navvy
