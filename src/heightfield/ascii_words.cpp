// SPDX-License-Identifier: Apache-2.0
#include "heightfield/ascii_words.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "core/limits.h"

namespace navvy::heightfield {
namespace {

std::string lower(std::string word) {
  for (char& c : word)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return word;
}

bool is_key(const std::string& word) {
  static const char* const keys[] = {"ncols",     "nrows",     "xllcorner", "yllcorner", "xllcenter",
                                     "yllcenter", "cellsize",  "dx",        "dy",        "nodata_value",
                                     "nodata",    "byteorder", "xllcentre", "yllcentre"};
  const std::string low = lower(word);
  return std::any_of(std::begin(keys), std::end(keys), [&](const char* key) { return low == key; });
}

/// As the system's library and Windows write them.
bool is_not_finite(std::string_view word) {
  if (!word.empty() && (word.front() == '-' || word.front() == '+')) word.remove_prefix(1);
  const std::string low = lower(std::string(word));
  for (const char* name : {"nan", "inf", "infinity", "1.#qnan", "1.#snan", "1.#ind", "1.#inf"})
    if (low == name) return true;
  return false;
}

bool is_number(const std::string& word) {
  std::string text = word;
  std::replace(text.begin(), text.end(), ',', '.');
  const char* first = text.data();
  if (!text.empty() && text.front() == '+') ++first;
  double value = 0;
  const auto [end, failed] = std::from_chars(first, text.data() + text.size(), value);
  // Out of double's range is a number all the same; the reader judges heights.
  const bool read = failed == std::errc() || failed == std::errc::result_out_of_range;
  return (read && end == text.data() + text.size()) || is_not_finite(word);
}

/// Words of a file with their lines.
class Words {
 public:
  explicit Words(const std::string& path) : path_(path), file_(std::fopen(path.c_str(), "rb"), std::fclose) {
    if (!file_) throw FileError("cannot read '" + path + "': " + std::strerror(errno));
  }
  /// False at the end. Of a word that is no number for its length alone the rest is left out.
  bool next(std::string& word, std::int64_t& line) {
    word.clear();
    int c = get();
    for (; c == ' ' || (c >= '\t' && c <= '\r'); c = get())
      if (c == '\n') ++line_;
    line = line_;
    for (; c >= 0 && c != ' ' && !(c >= '\t' && c <= '\r'); c = get())
      if (word.size() <= limits::kMapWordBytes) word += static_cast<char>(c);
    if (c == '\n') ++line_;
    return !word.empty();
  }

 private:
  int get() {
    if (at_ == held_) {
      held_ = std::fread(buffer_.data(), 1, buffer_.size(), file_.get());
      at_ = 0;
      if (held_ == 0) {
        if (std::ferror(file_.get()) != 0) throw FileError("cannot read '" + path_ + "': " + std::strerror(errno));
        return -1;
      }
    }
    return static_cast<unsigned char>(buffer_[at_++]);
  }

  std::string path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::vector<char> buffer_ = std::vector<char>(1 << 16);
  std::size_t at_ = 0, held_ = 0;
  std::int64_t line_ = 1;
};

[[noreturn]] void refuse(const std::string& path, std::int64_t line, const std::string& word) {
  throw InputError(Fault{Fault::Severity::kError, path, static_cast<int>(line), "terrain", word,
                         "is neither a key of an ESRI ASCII header nor a number",
                         "correct the map: what is not known is the NODATA_value"});
}

void look_through(const std::string& path, std::int64_t numbers) {
  Words words(path);
  std::string word;
  std::int64_t line = 0, seen = 0;
  // The header: keys with their values, until a number stands where a key would.
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
    throw InputError(Fault{Fault::Severity::kError, path, 0, "terrain", std::to_string(bytes) + " bytes",
                           "an ESRI ASCII map may have at most " + std::to_string(limits::kMapTextBytes),
                           "convert it with gdal_translate -of GTiff -co TILED=YES"});
  try {
    look_through(path, numbers);
  } catch (const FileError& failure) {
    throw InputError(Fault{Fault::Severity::kError, path, 0, "terrain", "", failure.what(), "check the path"});
  }
}

}  // namespace navvy::heightfield
