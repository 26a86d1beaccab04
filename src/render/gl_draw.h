// SPDX-License-Identifier: Apache-2.0
// Draws sky, ground and soil with plain OpenGL: large meshes that change often, with colours
// already lit.
#pragma once

#include <vector>

#include "render/shadow_map.h"
#include "render/terrain_mesh.h"
#include "render/view.h"

namespace navvy::render {

/// Textures and state of the parts that Coin does not draw. Its context must be current in every
/// call. Coin draws the machines; large meshes that change from picture to picture are drawn here
/// as vertex arrays, without nodes.
class GlDraw {
 public:
  /// Distances at which haze starts and is complete [m].
  static constexpr float kFogStart = 40, kFogEnd = 700;

  /// Clears the picture and sets the camera. Coin's state is saved until `end`.
  void begin(const View& view, const Lighting& lighting);
  /// Draws the ground with a fine grain texture and the machines' shadow. Haze and shadow cost time
  /// for every pixel, so a part has them only where they reach.
  void ground(const std::vector<GroundPart>& parts, const View& view, const ShadowMap& shadows,
              const Lighting& lighting);
  /// Draws the sky where nothing is in front of it; call it after the ground.
  void sky(const View& view, const Lighting& lighting);
  /// Draws closed bodies with haze; call it after the ground and before the sky.
  void lumps(const Mesh& mesh);
  /// Restores Coin's state. Every `begin` needs one, also when drawing is cut short.
  void end();

 private:
  // The grain texture is created at its first use and stays in GL's memory.
  void make_grain();
  void place_grain(bool on_walls);
  void bind_grain();
  // Uploads the mask again when its version differs from the one in the texture.
  void bind_shadow(const ShadowMap& shadows, const Lighting& lighting);

  unsigned grain_ = 0, shadow_ = 0;
  // Version of the mask in the texture.
  std::uint64_t shadow_version_ = 0;
};

}  // namespace navvy::render
