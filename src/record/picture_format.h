// SPDX-License-Identifier: Apache-2.0
// Form in which the pictures of a run are written.
#pragma once

namespace navvy::record {

/// Form in which pictures are written.
enum class PictureFormat {
  /// Videos if the program ffmpeg is found, PNG files otherwise.
  kAuto,
  /// One video per camera, `frames/<camera>.mp4` or `.webm`; ffmpeg must be found.
  kVideo,
  /// One PNG file per picture, `frames/<camera>_<number>.png`.
  kPng
};

}  // namespace navvy::record
