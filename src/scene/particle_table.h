// SPDX-License-Identifier: Apache-2.0
// The active soil of a world at one instant as named arrays, for files and for other programs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace navvy::scene {

/// Type of the elements of a ParticleArray.
enum class ParticleElement { kUint16, kUint32, kFloat32, kFloat64 };

/// Returns the size of one element of this type [bytes].
std::size_t size_of(ParticleElement type);
/// Returns the name of the element type in NumPy, such as "float32".
const char* name_of(ParticleElement type);

/// One quantity of all particles of a ParticleTable: its description, and a view of its elements,
/// which is valid as long as the table is neither changed nor destroyed.
struct ParticleArray {
  /// Name of the quantity, such as "velocity".
  std::string name;
  /// Unit of the elements; "1" for dimensionless numbers.
  std::string unit;
  /// One-line description.
  std::string meaning;
  /// Type of the elements.
  ParticleElement type = ParticleElement::kFloat32;
  /// Lengths of the dimensions of one particle's value: empty for a scalar, {3} for a vector,
  /// {3, 3} for a matrix.
  std::vector<int> shape;
  /// Names of the elements of one particle's value in row-major order, such as "x", "y", "z"; empty
  /// for a scalar.
  std::vector<std::string> components;
  /// Elements of all particles in row-major order, particle by particle, as they are in memory.
  std::span<const std::byte> bytes;

  /// Returns the number of elements per particle.
  std::size_t width() const { return components.empty() ? 1 : components.size(); }
  /// Returns the size of one particle's value [bytes].
  std::size_t stride() const { return width() * size_of(type); }
};

/// Soil that particles of a table consist of.
struct ParticleSoil {
  /// Name of the soil in its scene.
  std::string name;
  /// Density of the undisturbed soil [kg/m3].
  double bank_density = 0;
};

/// All active soil particles of a world at one instant. Members that have several elements per
/// particle hold them one particle after the other; all members have the particles in the same
/// order. Frame and quantities are those of `arrays`, which describes each member.
struct ParticleTable {
  /// Simulated time [s].
  double time = 0;
  /// Number of base steps since the start of the simulation.
  std::uint64_t steps = 0;
  /// Soils of the scene; `soil` counts in this list.
  std::vector<ParticleSoil> soils;

  // Members as in `arrays`.
  std::vector<std::uint32_t> id;
  std::vector<double> position;
  std::vector<float> velocity;
  std::vector<double> mass;
  std::vector<std::uint16_t> soil;
  std::vector<float> volume_ratio;
  std::vector<float> density;
  std::vector<float> density_state;
  std::vector<float> plastic_shear;
  std::vector<float> stress;
  std::vector<float> velocity_gradient;

  /// Returns the number of particles.
  std::size_t count() const { return id.size(); }
  /// Sets the number of particles; values of new particles are zero.
  void resize(std::size_t count);
  /// Returns all quantities with their descriptions, in the order in which files have them.
  std::vector<ParticleArray> arrays() const;
  /// Returns the quantities called `names`, in this order. @throws InputError for an unknown name,
  /// suggesting the most similar one.
  std::vector<ParticleArray> arrays(const std::vector<std::string>& names) const;
};

}  // namespace navvy::scene
