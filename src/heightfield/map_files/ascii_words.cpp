// SPDX-License-Identifier: Apache-2.0
#include "heightfield/map_files/ascii_words.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>

#include "core/error.h"
#include "core/file.h"
#include "core/limits.h"

namespace navvy::heightfield {
namespace {

// Returns true for the keys that GDAL knows.
bool is_key(std::string_view word) {
  static const char* const keys[] = {
      "ncols", "nrows", "xllcorner",    "yllcorner", "xllcenter", "yllcenter", "cellsize",
      "dx",    "dy",    "nodata_value", "nodata",    "byteorder", "xllcentre", "yllcentre"};
  const std::string low = lower_case(word);
  return std::any_of(std::begin(keys), std::end(keys), [&](const char* key) { return low == key; });
}

/// Recognises NaN and infinity as the C library and Windows write them.
std::optional<double> not_finite(std::string_view word) {
  const bool minus = !word.empty() && word.front() == '-';
  if (minus || (!word.empty() && word.front() == '+')) word.remove_prefix(1);
  const std::string low = lower_case(word);
  for (const char* name : {"nan", "1.#qnan", "1.#snan", "1.#ind"})
    if (low == name) return std::numeric_limits<double>::quiet_NaN();
  for (const char* name : {"inf", "infinity", "1.#inf"})
    if (low == name) return minus ? -INFINITY : INFINITY;
  return std::nullopt;
}

bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

/// Recognises [+-]digits[.digits], the form of nearly every height, at a fifth of the cost of
/// parsing it.
bool is_plain_number(std::string_view word) {
  std::size_t at = !word.empty() && (word.front() == '-' || word.front() == '+') ? 1 : 0,
              digits = 0;
  const auto count = [&] {
    for (; at < word.size() && word[at] >= '0' && word[at] <= '9'; ++at) ++digits;
  };
  count();
  if (at < word.size() && word[at] == '.') ++at;
  count();
  return digits > 0 && at == word.size();
}

// Tries the cheap form first, which nearly every height has.
bool is_number(std::string_view word) { return is_plain_number(word) || map_number(word); }

[[noreturn]] void refuse(
    const std::string& path, std::int64_t line, std::string_view word,
    const std::string& rule = "is neither a key of an ESRI ASCII header nor a number",
    const std::string& remedy = "correct the map: what is not known is the NODATA_value") {
  throw InputError(Fault{Fault::Severity::kError, path, static_cast<int>(line), "terrain",
                         std::string(word.substr(0, limits::kMapWordBytes + 1)), rule, remedy});
}

// Reads only as many words as the grid has cells: text behind them is ignored, as GDAL does.
std::int64_t look_through(
    const std::string& path, std::int64_t numbers,
    const std::function<void(std::int64_t index, std::int64_t position)>& found) {
  TextWords words(path);
  std::string_view word;
  std::int64_t line = 0, seen = 0;
  if (!read_ascii_header(path, words, word, line, {})) return 0;
  for (; seen < numbers; ++seen) {
    if (word.size() > limits::kMapWordBytes || !is_number(word)) refuse(path, line, word);
    if (found) found(seen, words.position());
    if (!words.next(word, line)) return seen + 1;
  }
  return seen;
}

}  // namespace

TextWords::TextWords(const std::string& path)
    : path_(path), file_(std::fopen(path.c_str(), "rb"), std::fclose) {
  if (!file_) throw FileError("cannot read '" + path + "': " + std::strerror(errno));
}

bool TextWords::next(std::string_view& word, std::int64_t& line) {
  word = {};
  do {
    for (; at_ < held_ && is_space(buffer_[at_]); ++at_)
      if (buffer_[at_] == '\n') ++line_;
  } while (at_ == held_ && refill());
  line = line_;
  word_at_ = begin_ + static_cast<std::int64_t>(at_);
  word = rest_of_word();
  if (at_ < held_ || word.empty()) return !word.empty();
  // The word continues in the next piece of the file.
  long_.clear();
  do {
    long_ += word.substr(
        0, limits::kMapWordBytes + 1 - std::min(long_.size(), limits::kMapWordBytes + 1));
    if (at_ < held_ || !refill()) break;
    word = rest_of_word();
  } while (!word.empty());
  word = long_;
  return true;
}

std::string_view TextWords::rest_of_word() {
  const std::size_t from = at_;
  while (at_ < held_ && !is_space(buffer_[at_])) ++at_;
  return {buffer_.data() + from, at_ - from};
}

bool TextWords::refill() {
  begin_ += static_cast<std::int64_t>(held_);
  held_ = std::fread(buffer_.data(), 1, buffer_.size(), file_.get());
  at_ = 0;
  if (held_ == 0 && std::ferror(file_.get()) != 0)
    throw FileError("cannot read '" + path_ + "': " + std::strerror(errno));
  return held_ > 0;
}

void TextWords::seek(std::int64_t position) {
  if (position < begin_ || position >= begin_ + static_cast<std::int64_t>(held_)) {
    // Maps are read from their last row to their first: most of the buffer lies before it.
    const auto before = static_cast<std::int64_t>(buffer_.size() / 4 * 3);
    begin_ = std::max<std::int64_t>(position - before, 0);
    held_ = 0;
    if (::fseeko(file_.get(), begin_, SEEK_SET) != 0)
      throw FileError("cannot read '" + path_ + "': " + std::strerror(errno));
    refill();
  }
  at_ = std::min(static_cast<std::size_t>(position - begin_), held_);
}

// The keys of the format may be in upper or lower case.
std::string lower_case(std::string_view text) {
  std::string word(text);
  for (char& c : word)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return word;
}

std::optional<double> map_number(std::string_view word) {
  std::string text(word);
  std::replace(text.begin(), text.end(), ',', '.');
  const char *first = text.data(), *end = first + text.size();
  // The C library reads no number after two signs.
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') ++first;
  double value = 0;
  const auto [next, failed] = std::from_chars(first, end, value);
  if (next != end || (failed != std::errc() && failed != std::errc::result_out_of_range))
    return not_finite(word);
  // A value outside the range of double is still a number; the reader judges heights. A word as
  // short as those of a map leaves the range by its exponent only.
  if (failed == std::errc::result_out_of_range)
    return text.find("e-") != std::string::npos || text.find("E-") != std::string::npos ? 0.0
           : *first == '-'                                                              ? -INFINITY
                                                                                        : INFINITY;
  return value;
}

bool read_ascii_header(const std::string& path, TextWords& words, std::string_view& word,
                       std::int64_t& line,
                       const std::function<void(const std::string& key, double value)>& take) {
  std::int64_t header_line = 0;
  while (words.next(word, line)) {
    if (!is_key(word)) {
      // GDAL ignores it and begins with the next line.
      if (line == header_line)
        refuse(path, line, word, "stands behind a value of the header",
               "begin the heights in a line of their own");
      return true;
    }
    const std::string key = lower_case(word);
    if (!words.next(word, line)) return false;
    header_line = line;
    if (key == "byteorder") continue;  // its value is a word
    const std::optional<double> value = map_number(word);
    if (!value) refuse(path, line, word);
    if (take) take(key, *value);
  }
  return false;
}

// Takes a file of any size apart from the limit, as no more than a piece is in memory.
std::int64_t check_words(
    const std::string& path, std::int64_t numbers,
    const std::function<void(std::int64_t index, std::int64_t position)>& found) {
  std::error_code unknown;
  const std::uintmax_t bytes = std::filesystem::file_size(path, unknown);
  if (!unknown && bytes > limits::kMapTextBytes)
    throw InputError(
        Fault{Fault::Severity::kError, path, 0, "terrain", std::to_string(bytes) + " bytes",
              "an ESRI ASCII map may have at most " + std::to_string(limits::kMapTextBytes),
              "convert it with gdal_translate -of GTiff -co TILED=YES"});
  try {
    return look_through(path, numbers, found);
  } catch (const FileError& failure) {
    throw InputError(
        Fault{Fault::Severity::kError, path, 0, "terrain", "", failure.what(), "check the path"});
  }
}

}  // namespace navvy::heightfield
