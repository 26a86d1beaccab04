// SPDX-License-Identifier: Apache-2.0
// Finds text in an ESRI ASCII grid where numbers are expected.
#pragma once

#include <cstdint>
#include <string>

namespace navvy::heightfield {

/// Checks the header and the first `numbers` heights of the file for words that are neither a key
/// of the format nor a number. GDAL would silently read such a word as 0 m. Every spelling that
/// GDAL accepts is a number, including decimal commas and "nan". Reads the file in pieces; refuses
/// a file beyond the limit of core/limits.h.
/// @throws InputError naming file, line and word.
void check_words(const std::string& path, std::int64_t numbers);

}  // namespace navvy::heightfield
