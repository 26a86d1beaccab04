// SPDX-License-Identifier: Apache-2.0
// Interface of the file that cmake/EmbedKernels.cmake generates.
#pragma once

namespace navvy::device {

/// One file of kernels/ at build time. Both texts are literals.
struct EmbeddedFile {
  /// Path relative to kernels/.
  const char* path;
  const char* text;
};

/// Returns all files; the array ends with a null path.
const EmbeddedFile* embedded_files();

}  // namespace navvy::device
