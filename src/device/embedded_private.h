// SPDX-License-Identifier: Apache-2.0
// What cmake/EmbedKernels.cmake generates.
#pragma once

namespace navvy::device {

/// One file of kernels/ as the build found it. Both texts are literals and live as long as the
/// program.
struct EmbeddedFile {
  const char* path;  ///< relative to kernels/
  const char* text;
};

/// Ends with a null path.
const EmbeddedFile* embedded_files();

}  // namespace navvy::device
