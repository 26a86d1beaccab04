// SPDX-License-Identifier: Apache-2.0
// Makes a machine of our own from one of another simulator: `navvy import`.
#pragma once

#include <string>
#include <vector>

namespace navvy::scene_io {

/// Choices of an import.
struct ImportOptions {
  std::string folder;  ///< folder that receives model.sdf, meshes/ and IMPORT.md
  /// Density [kg/m3] by which links with a placeholder for a mass get mass, centre and inertia from
  /// their shapes; 0: they keep what the file says.
  double density = 0;
};

/// Writes the machine of `file` (SDF or URDF) into a folder of its own as a machine of Navvy.
/// Meshes are copied beside it. Round links on joints without end become wheels with tyres, steered
/// ones with their joint, and get a drive that fits them. Joints that start beyond their limits
/// start at the limit; masses that are placeholders are named, or replaced by `density`. Arms,
/// buckets and cylinders are not recognised. Returns what was made, assumed and not recognised as
/// sentences, which IMPORT.md holds, too.
/// @throws InputError if the file is no sound machine or the folder holds a model.sdf already
/// @throws FileError if a file cannot be written
std::vector<std::string> import_machine(const std::string& file, const ImportOptions& options);

}  // namespace navvy::scene_io
