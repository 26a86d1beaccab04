// SPDX-License-Identifier: Apache-2.0
// Draws sky, ground and soil with plain OpenGL. Their meshes are large, change often, and already
// contain lit colours.
#pragma once

#include <vector>

#include "render/shadow_map.h"
#include "render/terrain_mesh.h"
#include "render/view.h"

namespace navvy::render {

/// Draws the parts of a picture that Coin does not draw, as vertex arrays without scene graph
/// nodes. (Coin draws the machines.) The object owns two textures. Its OpenGL context must be
/// current in every call.
class GlDraw {
 public:
  /// Distances from the camera at which haze begins and at which it hides everything [m].
  static constexpr float kFogStart = 40, kFogEnd = 700;

  /// Clears the picture, sets the camera, and saves Coin's OpenGL state until `end`.
  void begin(const View& view, const Lighting& lighting);
  /// Draws the ground with a texture of fine grains and the shadows of the machines. Haze and
  /// shadows are enabled only for those parts of the ground that they reach, because they cost time
  /// for every pixel.
  void ground(const std::vector<GroundPart>& parts, const View& view, const ShadowMap& shadows,
              const Lighting& lighting);
  /// Draws the sky wherever nothing has been drawn yet. Call it after `ground` and `lumps`.
  void sky(const View& view, const Lighting& lighting);
  /// Draws the closed bodies in `mesh` (the loose soil) with haze. Call it after `ground` and
  /// before `sky`.
  void lumps(const Mesh& mesh);
  /// Restores Coin's OpenGL state. Every `begin` needs a call of `end`, even if drawing fails in
  /// between.
  void end();

 private:
  /// Creates the grain texture. It remains in the memory of the OpenGL context.
  void make_grain();
  /// Sets the projection of the grain texture: from the side for walls, else from above.
  void place_grain(bool on_walls);
  /// Binds the grain texture, and creates it at the first call.
  void bind_grain();
  /// Binds the shadow mask as a texture, and uploads the mask if it has changed since the last
  /// upload.
  void bind_shadow(const ShadowMap& shadows, const Lighting& lighting);

  // OpenGL names of the two textures; 0 before they are created.
  unsigned grain_ = 0, shadow_ = 0;
  // ShadowMap::version of the mask last uploaded.
  std::uint64_t shadow_version_ = 0;
};

}  // namespace navvy::render
