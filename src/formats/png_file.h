// SPDX-License-Identifier: Apache-2.0
// Encodes pixels as PNG.
#pragma once

#include <cstdint>
#include <vector>

namespace navvy::formats {

/// Channels of a pixel in the order of PNG; the value is their number.
enum class PixelKind { kGrayAlpha = 2, kRgba = 4 };

/// Returns a PNG with 8 bits per channel, from rows without padding, top row first. @throws Error
/// when the bytes do not fill the picture.
std::vector<char> png_bytes(PixelKind kind, int width, int height,
                            const std::vector<std::uint8_t>& pixels);

}  // namespace navvy::formats
