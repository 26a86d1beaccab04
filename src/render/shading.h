// SPDX-License-Identifier: Apache-2.0
// Lighting of soil: one sun, a sky above, and light reflected from the ground below. Colours are
// computed on the CPU, one per vertex. All functions are pure, so that pictures are reproducible.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "scene/machine.h"
#include "scene/scene.h"

namespace navvy::render {

/// Vector of three single-precision numbers: a position in W [m], or a colour (red, green, blue; 0
/// to 1).
using Vec3f = Eigen::Vector3f;

/// A point of a mesh with its lit colour, in the memory layout that OpenGL reads.
struct Vertex {
  /// Position in W [m]. Single precision is sufficient within a few hundred metres of the origin.
  float x, y, z;
  /// Lit colour in sRGB; `a` (alpha) is not used.
  std::uint8_t r, g, b, a;
};
static_assert(sizeof(Vertex) == 16);

/// Light sources of a scene. Each colour is a factor (red, green, blue) by which the colour of a
/// surface is multiplied.
struct Lighting {
  /// Unit vector towards the sun in W.
  Vec3f to_sun = Vec3f(0.5f, -0.35f, 0.8f).normalized();
  /// Colour of direct sunlight.
  Vec3f sun = Vec3f(0.95f, 0.92f, 0.84f);
  /// Colour of the ambient light from the sky, on surfaces that face up.
  Vec3f sky = Vec3f(0.46f, 0.50f, 0.58f);
  /// Colour of the ambient light from the ground, on surfaces that face down.
  Vec3f ground = Vec3f(0.24f, 0.21f, 0.17f);
  /// Colour of the horizon, into which distant ground fades.
  Vec3f haze = Vec3f(0.78f, 0.83f, 0.88f);
  /// Colour of the sky overhead.
  Vec3f zenith = Vec3f(0.28f, 0.47f, 0.74f);

  bool operator==(const Lighting&) const = default;
};

/// Returns the lighting of a scene. The first light is the sun, and all further lights are ignored.
/// Without lights, the default of scene::Light is the sun.
Lighting make_lighting(const std::vector<scene::Light>& lights);

/// Returns the lit colour of a matt surface. `albedo` is its unlit colour, `normal` its unit normal
/// in W; `sun` and `open` are the visible fractions of sun and sky (0 to 1). Bright colours
/// approach kBrightest without reaching it, so that pale soil keeps its grain in the sun.
inline Vec3f shade(const Lighting& light, const Vec3f& albedo, const Vec3f& normal, float sun,
                   float open) {
  // A side turned away from the sun receives no direct light.
  const float direct = std::max(0.0f, normal.dot(light.to_sun)) * sun;
  // From 0 looking down to 1 looking up, so that ambient light changes smoothly.
  const float up = 0.5f + 0.5f * normal.z();
  const Vec3f ambient = light.ground + (light.sky - light.ground) * up;
  const Vec3f linear = albedo.cwiseProduct(light.sun * direct + ambient * open);
  constexpr float kShoulder = 0.5f, kBrightest = 0.82f;
  const float most = linear.maxCoeff();
  if (most <= kShoulder) return linear;
  constexpr float kRange = kBrightest - kShoulder;
  return linear * ((kShoulder + kRange * (1 - std::exp((kShoulder - most) / kRange))) / most);
}

/// Returns the factor by which the lit colour of level ground is multiplied where a body leaves the
/// fraction `sun` (0 to 1) of the sun visible: the sky still lights a shadow.
inline Vec3f shadow_tone(const Lighting& light, float sun) {
  const Vec3f level = light.sun * std::max(0.2f, light.to_sun.z()) + light.sky;
  const Vec3f left = light.sky.cwiseQuotient(level) * 0.92f;
  return left + (Vec3f::Ones() - left) * sun;
}

/// Converts a value, clamped to 0..1, to a byte in 0..255.
inline std::uint8_t to_byte(float value) {
  return static_cast<std::uint8_t>(std::clamp(value, 0.0f, 1.0f) * 255.0f + 0.5f);
}

/// Returns a smooth transition: 0 for x <= low, 1 for x >= high, and a cubic with zero slope at
/// both ends in between.
inline float smooth_step(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

/// Returns a hash of a number; consecutive numbers give unrelated hashes. Not cryptographic.
inline std::uint32_t hash_u32(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}

/// Returns a pseudo-random number, uniform in 0 <= u < 1, that is a pure function of the arguments.
/// It uses the upper 24 bits of a hash, so every result is exact in single precision.
inline float hash_unit(std::uint32_t x, std::uint32_t y = 0, std::uint32_t z = 0) {
  // Each number is mixed into the next, so that no two can cancel.
  const std::uint32_t h = hash_u32(x + 0x9e3779b9u * hash_u32(y + 0x85ebca6bu * hash_u32(z)));
  return static_cast<float>(h >> 8) * (1.0f / 16777216.0f);
}

/// Returns smooth noise in -1..1 at the point (x, y), with a wavelength of 1. Value and slope are
/// continuous. Different seeds give unrelated noise.
float value_noise(float x, float y, std::uint32_t seed);

}  // namespace navvy::render
