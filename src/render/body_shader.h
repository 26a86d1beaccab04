// SPDX-License-Identifier: Apache-2.0
// Lights the bodies that Coin draws: OpenGL's own lights, and the shadows that bodies throw on
// themselves and on each other.
#pragma once

#include <cstdint>
#include <map>

#include "render/shadow_map.h"

namespace navvy::render {

/// A program that OpenGL runs for each corner and each pixel of a body. It computes the light of
/// Coin's materials and of three directional lights as OpenGL does by itself, and takes away that
/// of the first one, the sun, where a shadow map says so. Its OpenGL context must be current in
/// every call.
class BodyShader {
 public:
  /// Uses the program for what is drawn next, with the shadows of `map`. `X_CW` is the affine map
  /// from W to the camera's frame. Does nothing if this OpenGL cannot compile the program; bodies
  /// then have no shadows on them.
  void use(const ShadowMap& map, const Eigen::Matrix4f& X_CW);
  /// Returns to the lights of OpenGL.
  void stop() const;

 private:
  // Depths of a map in the memory of the OpenGL context.
  struct Texture {
    unsigned name = 0;
    // ShadowMap::version of the depths.
    std::uint64_t version = 0;
  };
  // Compiles the program. Leaves it at 0 if that fails.
  void compile();

  // OpenGL name of the program; 0: none.
  unsigned program_ = 0;
  bool compiled_ = false;
  // Places of its inputs.
  int to_map_ = -1, shadows_ = -1, texel_ = -1;
  // One entry per map that was used.
  std::map<const ShadowMap*, Texture> textures_;
};

}  // namespace navvy::render
