// SPDX-License-Identifier: Apache-2.0
// Light on soil, computed on the host per vertex: one sun, a sky above, warm light from the ground
// below. All functions are pure, so that pictures repeat.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "scene/machine.h"
#include "scene/scene.h"

namespace navvy::render {

using Vec3f = Eigen::Vector3f;

/// A point with a lit colour, as passed to GL.
struct Vertex {
  // In W [m]; single precision is enough within a few hundred metres of the origin.
  float x, y, z;
  // Colour as displayed; alpha is unused.
  std::uint8_t r, g, b, a;
};
static_assert(sizeof(Vertex) == 16);

/// The light of a scene as factors of a surface's colour. `to_sun` is a unit vector in W.
struct Lighting {
  Vec3f to_sun = Vec3f(0.5f, -0.35f, 0.8f).normalized();
  Vec3f sun = Vec3f(0.95f, 0.92f, 0.84f);
  Vec3f sky = Vec3f(0.46f, 0.50f, 0.58f);
  Vec3f ground = Vec3f(0.24f, 0.21f, 0.17f);
  /// Colour of the horizon, into which far ground fades.
  Vec3f haze = Vec3f(0.78f, 0.83f, 0.88f);
  /// Colour of the sky above.
  Vec3f zenith = Vec3f(0.28f, 0.47f, 0.74f);

  bool operator==(const Lighting&) const = default;
};

/// Returns the lighting of a scene. The first light is the sun; none: the default of scene::Light.
/// Further lights are not drawn.
Lighting make_lighting(const std::vector<scene::Light>& lights);

/// Returns the colour of a matt surface; `sun` and `open` are the visible shares of sun and sky.
/// Light and albedo are factors, so the result may exceed 1; `to_byte` clamps it.
inline Vec3f shade(const Lighting& light, const Vec3f& albedo, const Vec3f& normal, float sun,
                   float open) {
  // A side turned away from the sun receives no direct light.
  const float direct = std::max(0.0f, normal.dot(light.to_sun)) * sun;
  // From 0 looking down to 1 looking up, so that ambient light changes smoothly.
  const float up = 0.5f + 0.5f * normal.z();
  const Vec3f ambient = light.ground + (light.sky - light.ground) * up;
  return albedo.cwiseProduct(light.sun * direct + ambient * open);
}

/// Converts a factor to a byte: rounded and clamped to 0..1.
inline std::uint8_t to_byte(float value) {
  return static_cast<std::uint8_t>(std::clamp(value, 0.0f, 1.0f) * 255.0f + 0.5f);
}

/// Returns 0 below `low`, 1 above `high`, with zero slope at both.
inline float smooth_step(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

/// Mixes all bits of a number, so that neighbouring numbers give unrelated results. Not
/// cryptographic.
inline std::uint32_t hash_u32(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}

/// Returns a uniform value in 0..1 from integers. The upper 24 bits count, so that every value is
/// exactly a float.
inline float hash_unit(std::uint32_t x, std::uint32_t y = 0, std::uint32_t z = 0) {
  // Each number is mixed into the next, so that no two can cancel.
  const std::uint32_t h = hash_u32(x + 0x9e3779b9u * hash_u32(y + 0x85ebca6bu * hash_u32(z)));
  return static_cast<float>(h >> 8) * (1.0f / 16777216.0f);
}

/// Returns smooth noise of unit wavelength in -1..1, continuous with its slope.
float value_noise(float x, float y, std::uint32_t seed);

}  // namespace navvy::render
