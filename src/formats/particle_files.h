// SPDX-License-Identifier: Apache-2.0
// Writes the active soil of a world as files for other programs. Each format is implemented in a
// source file of its own; docs/howto/particles.md describes what the files hold. All writers write
// a new file next to the target and then rename it: after an error, a full disk or a kill, either
// the old or the complete new file exists.
#pragma once

#include <string>
#include <vector>

#include "scene/particle_table.h"

namespace navvy::formats {

/// A file format for particles: its names, and the function that writes it.
struct ParticleFormat {
  /// Name in options, such as "vtu".
  std::string name;
  /// File name extension, such as ".vtu".
  std::string extension;
  /// One-line description for the user.
  std::string meaning;
  /// Function that writes all quantities of `particles` to `path`. @throws FileError naming path
  /// and cause.
  void (*write)(const scene::ParticleTable& particles, const std::string& path) = nullptr;
};

/// Returns all formats, in the order in which the program lists them.
const std::vector<ParticleFormat>& particle_formats();
/// Returns the format called `name`. @throws InputError that suggests the most similar name.
const ParticleFormat& particle_format_named(const std::string& name);
/// Returns the format with the extension of the file name `path`. `option` is the name of the
/// option for the message. @throws InputError that lists the extensions.
const ParticleFormat& particle_format_of(const std::string& path, const std::string& option);

/// Returns the names of all formats as a list for messages: "npz, vtu or ply".
std::string particle_format_names();

/// Returns the text that describes a table beside its arrays, as JSON: format_version, count,
/// time_s, steps, soils (name, bank_density_kg_m3), and the name, type, unit and meaning of each
/// array. Ends with a line feed.
std::string particle_header(const scene::ParticleTable& particles);

}  // namespace navvy::formats
