// SPDX-License-Identifier: Apache-2.0
#include "heightfield/ascii_words.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "core/limits.h"

namespace navvy::heightfield {
namespace {

// The keys of the format may be in upper or lower case.
std::string lower(std::string_view text) {
  std::string word(text);
  for (char& c : word)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return word;
}

// Returns true for the keys that GDAL knows.
bool is_key(std::string_view word) {
  static const char* const keys[] = {
      "ncols", "nrows", "xllcorner",    "yllcorner", "xllcenter", "yllcenter", "cellsize",
      "dx",    "dy",    "nodata_value", "nodata",    "byteorder", "xllcentre", "yllcentre"};
  const std::string low = lower(word);
  return std::any_of(std::begin(keys), std::end(keys), [&](const char* key) { return low == key; });
}

/// Recognises NaN and infinity as the C library and Windows write them.
bool is_not_finite(std::string_view word) {
  if (!word.empty() && (word.front() == '-' || word.front() == '+')) word.remove_prefix(1);
  const std::string low = lower(word);
  for (const char* name : {"nan", "inf", "infinity", "1.#qnan", "1.#snan", "1.#ind", "1.#inf"})
    if (low == name) return true;
  return false;
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
bool is_number(std::string_view word) {
  if (is_plain_number(word)) return true;
  std::string text(word);
  std::replace(text.begin(), text.end(), ',', '.');
  const char* first = text.data();
  if (!text.empty() && text.front() == '+') ++first;
  double value = 0;
  const auto [end, failed] = std::from_chars(first, text.data() + text.size(), value);
  // A value outside the range of double is still a number; the reader judges heights.
  const bool read = failed == std::errc() || failed == std::errc::result_out_of_range;
  return (read && end == text.data() + text.size()) || is_not_finite(word);
}

/// Splits a file into words with their lines.
class Words {
 public:
  explicit Words(const std::string& path)
      : path_(path), file_(std::fopen(path.c_str(), "rb"), std::fclose) {
    if (!file_) throw FileError("cannot read '" + path + "': " + std::strerror(errno));
  }
  /// Reads the next word; returns false at the end. A word that is too long for a number is
  /// truncated. The word is a view of the buffer and valid until the next call.
  bool next(std::string_view& word, std::int64_t& line) {
    word = {};
    do {
      for (; at_ < held_ && is_space(buffer_[at_]); ++at_)
        if (buffer_[at_] == '\n') ++line_;
    } while (at_ == held_ && refill());
    line = line_;
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

 private:
  /// Returns the part of the word that the buffer holds.
  std::string_view rest_of_word() {
    const std::size_t from = at_;
    while (at_ < held_ && !is_space(buffer_[at_])) ++at_;
    return {buffer_.data() + from, at_ - from};
  }
  /// Refills the buffer, which has been read to its end; returns false at the end of the file.
  bool refill() {
    held_ = std::fread(buffer_.data(), 1, buffer_.size(), file_.get());
    at_ = 0;
    if (held_ == 0 && std::ferror(file_.get()) != 0)
      throw FileError("cannot read '" + path_ + "': " + std::strerror(errno));
    return held_ > 0;
  }

  std::string path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::vector<char> buffer_ = std::vector<char>(1 << 16);
  std::size_t at_ = 0, held_ = 0;
  std::int64_t line_ = 1;
  std::string long_;  ///< a word that lies across two pieces
};

[[noreturn]] void refuse(const std::string& path, std::int64_t line, std::string_view word) {
  throw InputError(Fault{Fault::Severity::kError, path, static_cast<int>(line), "terrain",
                         std::string(word.substr(0, limits::kMapWordBytes + 1)),
                         "is neither a key of an ESRI ASCII header nor a number",
                         "correct the map: what is not known is the NODATA_value"});
}

// Reads only as many words as the grid has cells: text behind them is ignored, as GDAL does.
void look_through(const std::string& path, std::int64_t numbers) {
  Words words(path);
  std::string_view word;
  std::int64_t line = 0, seen = 0;
  // The header consists of keys with their values, up to a number in the place of a key.
  while (words.next(word, line) && is_key(word)) {
    const bool order = lower(word) == "byteorder";  // its value is a word
    if (!words.next(word, line)) return;
    if (!order && !is_number(word)) refuse(path, line, word);
  }
  for (; !word.empty() && seen < numbers; ++seen) {
    if (word.size() > limits::kMapWordBytes || !is_number(word)) refuse(path, line, word);
    if (!words.next(word, line)) break;
  }
}

}  // namespace

void check_words(const std::string& path, std::int64_t numbers) {
  std::error_code unknown;
  const std::uintmax_t bytes = std::filesystem::file_size(path, unknown);
  if (!unknown && bytes > limits::kMapTextBytes)
    throw InputError(
        Fault{Fault::Severity::kError, path, 0, "terrain", std::to_string(bytes) + " bytes",
              "an ESRI ASCII map may have at most " + std::to_string(limits::kMapTextBytes),
              "convert it with gdal_translate -of GTiff -co TILED=YES"});
  try {
    look_through(path, numbers);
  } catch (const FileError& failure) {
    throw InputError(
        Fault{Fault::Severity::kError, path, 0, "terrain", "", failure.what(), "check the path"});
  }
}

}  // namespace navvy::heightfield
