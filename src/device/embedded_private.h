// SPDX-License-Identifier: Apache-2.0
// Interface of the file that cmake/EmbedKernels.cmake generates.
#pragma once

namespace navvy::device {

/// One file of kernels/, embedded when Navvy was built. Both members are string literals.
struct EmbeddedFile {
  const char* path;  ///< path relative to kernels/
  const char* text;  ///< content of the file
};

/// Returns an array of all embedded files; the last entry has a null path.
const EmbeddedFile* embedded_files();

}  // namespace navvy::device
