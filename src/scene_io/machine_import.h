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
  /// File with masses of links (scene_io/mass_file.h), which count before the density; empty: none.
  std::string masses;
};

/// Writes the machine of `file` (SDF or URDF) into a folder of its own as a machine of Navvy.
/// Meshes are copied beside it. Round links on joints without end become wheels with tyres, steered
/// ones with their joint, and get a drive that fits them. Joints that start beyond their limits
/// start at the limit; masses that are placeholders are named and listed in masses.csv, or replaced
/// by `masses` and `density`. The arm of an excavator gets its roles, a bucket, and drives
/// (scene_io/arm_import.h). Links that overlap are named. Returns what was made, repaired, assumed,
/// dropped and not recognised as sentences, which IMPORT.md holds, too.
/// @throws InputError if the file is no sound machine, the folder holds a model.sdf already, or
/// `masses` is faulty
/// @throws FileError if a file cannot be written
std::vector<std::string> import_machine(const std::string& file, const ImportOptions& options);

}  // namespace navvy::scene_io
