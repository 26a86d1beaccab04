// SPDX-License-Identifier: Apache-2.0
// Sky, ground and soil drawn with plain OpenGL: large meshes that change often, with colours
// already lit.
#pragma once

#include <vector>

#include "render/shadow_map.h"
#include "render/terrain_mesh.h"
#include "render/view.h"

namespace navvy::render {

/// Textures and state of the parts that Coin does not draw. Its context must be current in every
/// call. Coin draws machines; large meshes that change from picture to picture go this way, as
/// arrays, without nodes.
class GlDraw {
 public:
  static constexpr float kFogStart = 40, kFogEnd = 700;  ///< [m]

  /// Clears the picture and sets the camera. What Coin had set is put aside until `end`.
  void begin(const View& view, const Lighting& lighting);
  /// Ground with a fine grain over it and the machines' shadow. Haze and shadow cost time at every
  /// pixel, so that a part has them only where they reach.
  void ground(const std::vector<GroundPart>& parts, const View& view, const ShadowMap& shadows,
              const Lighting& lighting);
  /// Where nothing stands before it: comes after the ground.
  void sky(const View& view, const Lighting& lighting);
  /// Closed bodies. Drawn after the ground and before the sky, with haze.
  void lumps(const Mesh& mesh);
  /// Gives Coin its state back. Every `begin` needs one, also when the drawing between them is cut
  /// short.
  void end();

 private:
  // The grain is made at its first use, in GL's memory, and kept.
  void make_grain();
  void place_grain(bool on_walls);
  void bind_grain();
  // Sends the mask anew when its version differs from the one in the texture.
  void bind_shadow(const ShadowMap& shadows, const Lighting& lighting);

  unsigned grain_ = 0, shadow_ = 0;
  std::uint64_t shadow_version_ = 0;  ///< of the mask in the texture
};

}  // namespace navvy::render
