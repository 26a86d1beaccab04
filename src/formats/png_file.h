// SPDX-License-Identifier: Apache-2.0
// Encodes images as PNG.
#pragma once

#include <cstdint>
#include <vector>

namespace navvy::formats {

/// Colour channels of a pixel, in their order in the file. The numeric value of an enumerator is
/// the number of channels.
enum class PixelKind { kGrayAlpha = 2, kRgba = 4 };

/// Returns a PNG file with 8 bits per channel. `pixels` contains the rows without padding, top row
/// first. @throws Error if the number of bytes does not match the size of the image.
std::vector<char> png_bytes(PixelKind kind, int width, int height,
                            const std::vector<std::uint8_t>& pixels);

}  // namespace navvy::formats
