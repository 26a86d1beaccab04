// SPDX-License-Identifier: Apache-2.0
#include "render/shading.h"

namespace navvy::render {

Lighting make_lighting(const std::vector<scene::Light>& lights) {
  const scene::Light light = lights.empty() ? scene::Light{} : lights.front();
  // A light's direction is the one in which it travels; shading needs the direction to the sun.
  Lighting out;
  const Vec3f direction = light.direction.cast<float>();
  // A direction of zero length keeps the default instead of dividing by zero.
  if (direction.norm() > 1e-6f) out.to_sun = -direction.normalized();
  out.sun = 0.95f * Vec3f(light.color.r, light.color.g, light.color.b);
  return out;
}

float value_noise(float x, float y, std::uint32_t seed) {
  // Rounded down before the cast, so that the lattice continues below zero without a seam.
  const float fx = std::floor(x), fy = std::floor(y);
  const auto ix = static_cast<std::uint32_t>(static_cast<std::int32_t>(fx));
  const auto iy = static_cast<std::uint32_t>(static_cast<std::int32_t>(fy));
  const float tx = smooth_step(0, 1, x - fx), ty = smooth_step(0, 1, y - fy);
  const float a = hash_unit(ix, iy, seed), b = hash_unit(ix + 1, iy, seed);
  const float c = hash_unit(ix, iy + 1, seed), d = hash_unit(ix + 1, iy + 1, seed);
  return 2.0f * ((a + (b - a) * tx) * (1 - ty) + (c + (d - c) * tx) * ty) - 1.0f;
}

}  // namespace navvy::render
