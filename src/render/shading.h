// SPDX-License-Identifier: Apache-2.0
// Light on soil, computed on the host per vertex: one sun, a sky above, warm light from the ground
// below. Everything here is a pure function of its arguments, so that pictures repeat.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "scene/machine.h"
#include "scene/scene.h"

namespace navvy::render {

using Vec3f = Eigen::Vector3f;

/// Point with a lit colour, as handed to GL.
struct Vertex {
  // In W [m], as floats: what is drawn lies within a few hundred metres of the origin.
  float x, y, z;
  // Colours as they go to the screen, alpha unused.
  std::uint8_t r, g, b, a;
};
static_assert(sizeof(Vertex) == 16);

/// The light of a scene, as factors of a surface's colour. `to_sun` is a unit vector in W.
struct Lighting {
  Vec3f to_sun = Vec3f(0.5f, -0.35f, 0.8f).normalized();
  Vec3f sun = Vec3f(0.95f, 0.92f, 0.84f);
  Vec3f sky = Vec3f(0.46f, 0.50f, 0.58f);
  Vec3f ground = Vec3f(0.24f, 0.21f, 0.17f);
  // Haze and zenith are what the sky is painted with; the haze is also what far ground fades into.
  Vec3f haze = Vec3f(0.78f, 0.83f, 0.88f);    ///< colour of the horizon
  Vec3f zenith = Vec3f(0.28f, 0.47f, 0.74f);  ///< colour of the sky above

  bool operator==(const Lighting&) const = default;
};

/// The first light is the sun; none: the default of scene::Light. There is one sun; lights after
/// the first are not drawn.
Lighting make_lighting(const std::vector<scene::Light>& lights);

/// Colour of a matt surface; `sun` is the share of the sun that reaches it, `open` the share of the
/// sky. Light and albedo are factors, so what comes out may exceed 1; `to_byte` cuts it off.
inline Vec3f shade(const Lighting& light, const Vec3f& albedo, const Vec3f& normal, float sun,
                   float open) {
  // A side that is turned away from the sun gets none of it.
  const float direct = std::max(0.0f, normal.dot(light.to_sun)) * sun;
  // From 0 looking down to 1 looking up, so that the ambient light changes without an edge.
  const float up = 0.5f + 0.5f * normal.z();
  const Vec3f ambient = light.ground + (light.sky - light.ground) * up;
  return albedo.cwiseProduct(light.sun * direct + ambient * open);
}

/// A factor of 0 to 1 as a byte, rounded; what lies outside is cut off.
inline std::uint8_t to_byte(float value) {
  return static_cast<std::uint8_t>(std::clamp(value, 0.0f, 1.0f) * 255.0f + 0.5f);
}

/// 0 below `low`, 1 above `high`, without a kink at either.
inline float smooth_step(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

/// Mixes all bits of a number into all others: neighbouring numbers give unlike ones. No secret,
/// only spread.
inline std::uint32_t hash_u32(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}

/// Uniform in 0..1 from integers. The upper 24 bits count, so that every value is a float exactly.
inline float hash_unit(std::uint32_t x, std::uint32_t y = 0, std::uint32_t z = 0) {
  // The three numbers are mixed one into the other, so that no two of them can cancel.
  const std::uint32_t h = hash_u32(x + 0x9e3779b9u * hash_u32(y + 0x85ebca6bu * hash_u32(z)));
  return static_cast<float>(h >> 8) * (1.0f / 16777216.0f);
}

/// Smooth noise of unit wavelength, -1..1. Continuous, also in its slope.
float value_noise(float x, float y, std::uint32_t seed);

}  // namespace navvy::render
