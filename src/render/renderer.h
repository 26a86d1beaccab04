// SPDX-License-Identifier: Apache-2.0
// Draws a scene::Frame off-screen, without a display.
#pragma once

#include <memory>

#include "render/image.h"
#include "scene/frame.h"

namespace navvy::render {

/// What a caller chooses once; it holds for all pictures of a Renderer.
struct RenderOptions {
  /// Per pixel, 1 or 4; 4 smooths edges and costs about two to three times the time.
  int samples = 1;
  /// Ground beyond the site's edge, fading into haze; false: the site stands free.
  bool surroundings = true;
  bool shadows = true;  ///< machines and falling soil throw the sun's shadow on the ground
  /// Most ground triangles of one picture; the level of detail gets coarser to keep it.
  int triangle_budget = 40000;
};

/// What the last picture took: counts of what was drawn, and the host's wall time [ms]. They say
/// nothing of the picture before it.
struct RenderStats {
  int ground_triangles = 0, ground_tiles = 0;
  int particles_drawn = 0, particle_triangles = 0;
  int tiles_rebuilt = 0;
  double prepare_ms = 0, draw_ms = 0;  ///< ground, shadows and particles made; drawn
};

/// Draws ground, soil particles, machines, sky and shadows with Coin3D and OSMesa.
///
/// The same frame gives the same bytes on one Mesa version. One Renderer at a time in a process,
/// used from the thread that made it (Coin is not thread-safe). Ground is cached: a picture costs
/// what changed and what the camera sees.
class Renderer {
 public:
  /// @throws Error when no drawing context can be made.
  explicit Renderer(const RenderOptions& options = {});
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Draws `frame` as `camera` sees it; `depth`, when given, gets the depth picture of the same
  /// size. The ground's changed rectangles are trusted when its revision is the successor of the
  /// last one drawn; otherwise the heights are compared. @throws FileError or InputError naming a
  /// mesh file that cannot be read, Error for an impossible picture size.
  Image render(const scene::Frame& frame, const scene::FrameCamera& camera,
               DepthImage* depth = nullptr);

  /// Of the picture drawn last; zeros before the first.
  const RenderStats& stats() const;

  // Coin's and GL's headers stay in the source.
 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace navvy::render
