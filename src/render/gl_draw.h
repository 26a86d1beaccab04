// SPDX-License-Identifier: Apache-2.0
// Sky, ground and soil drawn with plain OpenGL: large meshes that change often, with colours already lit.
#pragma once

#include <vector>

#include "render/shadow_map.h"
#include "render/terrain.h"
#include "render/view.h"

namespace navvy::render {

/// Textures and state of the parts that Coin does not draw. Its context must be current in every call.
class GlDraw {
 public:
  static constexpr float kFogStart = 40, kFogEnd = 700;  ///< [m]

  /// Clears the picture and sets the camera.
  void begin(const View& view, const Lighting& lighting);
  /// Ground with a fine grain over it and the machines' shadow. Haze and shadow cost time at every pixel, so that a
  /// part has them only where they reach.
  void ground(const std::vector<GroundPart>& parts, const View& view, const ShadowMap& shadows,
              const Lighting& lighting);
  /// Where nothing stands before it: comes after the ground.
  void sky(const View& view, const Lighting& lighting);
  /// Closed bodies.
  void lumps(const Mesh& mesh);
  void end();

 private:
  void make_grain();
  void lay_grain(bool on_walls);
  void bind_grain();
  void bind_shadow(const ShadowMap& shadows, const Lighting& lighting);

  unsigned grain_ = 0, shadow_ = 0;
  std::uint64_t shadow_version_ = 0;  ///< of the mask in the texture
};

}  // namespace navvy::render
