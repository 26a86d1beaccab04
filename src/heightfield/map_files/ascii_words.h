// SPDX-License-Identifier: Apache-2.0
// Splits an ESRI ASCII grid, a text format for height maps, into its words, and finds those that
// are not numbers.
#pragma once

#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace navvy::heightfield {

/// Splits a text file into words with their lines. The file is read in pieces, so it may be larger
/// than memory.
class TextWords {
 public:
  /// Opens `path`. @throws FileError naming path and cause, as all functions here.
  explicit TextWords(const std::string& path);
  /// Reads the next word; returns false at the end. A word that is too long for a number is
  /// truncated. The word is a view of the buffer and valid until the next call.
  bool next(std::string_view& word, std::int64_t& line);
  /// Returns the position in the file of the word that `next` returned last [bytes].
  std::int64_t position() const { return word_at_; }
  /// Continues at a position in the file [bytes]. Lines are not counted any more. The positions
  /// shortly before and after it are in memory then.
  void seek(std::int64_t position);

 private:
  /// Returns the part of the word that the buffer holds.
  std::string_view rest_of_word();
  /// Refills the buffer, which has been read to its end; returns false at the end of the file.
  bool refill();

  std::string path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::vector<char> buffer_ = std::vector<char>(1 << 16);
  /// Position of the buffer in the file, and of the last word.
  std::int64_t begin_ = 0, word_at_ = 0;
  std::size_t at_ = 0, held_ = 0;
  std::int64_t line_ = 1;
  /// A word that lies across two pieces.
  std::string long_;
};

/// Returns `text` with the letters A to Z in lower case.
std::string lower_case(std::string_view text);

/// Returns the number that a word of a map stands for, as GDAL reads it: with a decimal point or
/// comma, also "nan", "inf" and "1.#QNAN". Returns no value for any other word.
std::optional<double> map_number(std::string_view word);

/// Reads the header of an ESRI ASCII grid, keys with their values up to the first number in the
/// place of a key, and passes each key in lower case and its value to `take`. Returns false if the
/// file ends there; otherwise `words` has read the first height, which is in `word`.
/// @throws InputError naming file, line and word for a value that is no number, and for a height in
/// a line of the header.
bool read_ascii_header(const std::string& path, TextWords& words, std::string_view& word,
                       std::int64_t& line,
                       const std::function<void(const std::string& key, double value)>& take);

/// Checks the header and the first `numbers` heights of the ESRI ASCII grid in file `path` for
/// words that are neither a header key nor a number. GDAL would silently read such a word as a
/// height of 0 m. Passes the index of every height and its position in the file to `found`, if that
/// is given. Returns how many of the heights the file has.
///
/// Every spelling that GDAL accepts counts as a number, including decimal commas and "nan".
/// @throws InputError naming file, line and word; also for a file that cannot be read or is larger
/// than limits::kMapTextBytes (core/limits.h).
std::int64_t check_words(
    const std::string& path, std::int64_t numbers,
    const std::function<void(std::int64_t index, std::int64_t position)>& found = {});

}  // namespace navvy::heightfield
