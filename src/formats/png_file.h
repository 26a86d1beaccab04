// SPDX-License-Identifier: Apache-2.0
// Pixels as PNG bytes.
#pragma once

#include <cstdint>
#include <vector>

namespace navvy::formats {

/// Bytes of a pixel, in PNG's order.
enum class PixelKind { kGray = 1, kGrayAlpha = 2, kRgb = 3, kRgba = 4 };

/// 8 bits a channel, top row first, rows without padding. @throws Error when the bytes do not fill
/// the picture.
std::vector<char> png_bytes(PixelKind kind, int width, int height,
                            const std::vector<std::uint8_t>& pixels);

}  // namespace navvy::formats
