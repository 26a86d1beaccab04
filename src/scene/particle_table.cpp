// SPDX-License-Identifier: Apache-2.0
#include "scene/particle_table.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "core/edit_distance.h"
#include "core/error.h"

namespace navvy::scene {
namespace {

template <class T>
constexpr ParticleElement element_of() {
  if constexpr (std::is_same_v<T, std::uint16_t>)
    return ParticleElement::kUint16;
  else if constexpr (std::is_same_v<T, std::uint32_t>)
    return ParticleElement::kUint32;
  else if constexpr (std::is_same_v<T, float>)
    return ParticleElement::kFloat32;
  else
    return ParticleElement::kFloat64;
}

/// Returns the names of the elements of a vector, of a symmetric tensor in the order of the law, or
/// of a matrix row by row; none for a scalar.
std::vector<std::string> components_of(std::size_t width) {
  if (width == 3) return {"x", "y", "z"};
  if (width == 6) return {"xx", "yy", "zz", "xy", "yz", "xz"};
  if (width == 9) return {"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"};
  return {};
}

template <class T>
ParticleArray describe(const std::vector<T>& values, std::vector<int> shape, const char* name,
                       const char* unit, const char* meaning) {
  std::size_t width = 1;
  for (const int length : shape) width *= static_cast<std::size_t>(length);
  return {name,
          unit,
          meaning,
          element_of<T>(),
          std::move(shape),
          components_of(width),
          std::as_bytes(std::span(values))};
}

}  // namespace

std::size_t size_of(ParticleElement type) {
  switch (type) {
    case ParticleElement::kUint16:
      return 2;
    case ParticleElement::kUint32:
    case ParticleElement::kFloat32:
      return 4;
    case ParticleElement::kFloat64:
      break;
  }
  return 8;
}

const char* name_of(ParticleElement type) {
  switch (type) {
    case ParticleElement::kUint16:
      return "uint16";
    case ParticleElement::kUint32:
      return "uint32";
    case ParticleElement::kFloat32:
      return "float32";
    case ParticleElement::kFloat64:
      break;
  }
  return "float64";
}

void ParticleTable::resize(std::size_t count) {
  id.resize(count);
  position.resize(3 * count);
  mass.resize(count);
  soil.resize(count);
  for (std::vector<float>* one : {&volume_ratio, &density, &density_state, &plastic_shear})
    one->resize(count);
  velocity.resize(3 * count);
  stress.resize(6 * count);
  velocity_gradient.resize(9 * count);
}

// The one list of quantities: files, answers of the control protocol and Python follow it.
std::vector<ParticleArray> ParticleTable::arrays() const {
  return {
      describe(id, {}, "id", "1", "number of the particle, unique in a run"),
      describe(position, {3}, "position", "m", "position in W"),
      describe(velocity, {3}, "velocity", "m/s", "velocity in axes of W"),
      describe(mass, {}, "mass", "kg", "mass, a multiple of 2^-24 kg"),
      describe(soil, {}, "soil", "1", "index in the list of soils"),
      describe(volume_ratio, {}, "volume_ratio", "1", "J: tracked volume / bank volume"),
      describe(density, {}, "density", "kg/m3", "bank density / J"),
      describe(density_state, {}, "density_state", "1",
               "J0: volume ratio without pressure, 1 in the bank, up to the swell when loose"),
      describe(plastic_shear, {}, "plastic_shear", "1", "plastic shear strain since the bank"),
      describe(stress, {6}, "stress", "Pa",
               "stress without its viscous part, positive in tension: xx, yy, zz, xy, yz, xz"),
      describe(velocity_gradient, {3, 3}, "velocity_gradient", "1/s",
               "velocity gradient: row i, column j is dv_i/dx_j"),
  };
}

std::vector<ParticleArray> ParticleTable::arrays(const std::vector<std::string>& names) const {
  const std::vector<ParticleArray> all = arrays();
  std::vector<ParticleArray> out;
  out.reserve(names.size());
  for (const std::string& name : names) {
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const ParticleArray& one) { return one.name == name; });
    if (found == all.end()) {
      std::vector<std::string> known;
      known.reserve(all.size());
      for (const ParticleArray& one : all) known.push_back(one.name);
      throw InputError(Fault{Fault::Severity::kError, "", 0, "particles", name,
                             "is not the name of a quantity of particles",
                             suggestion(name, known)});
    }
    out.push_back(*found);
  }
  return out;
}

}  // namespace navvy::scene
