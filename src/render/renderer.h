// SPDX-License-Identifier: Apache-2.0
// Draws a scene::Frame off-screen, without a display.
#pragma once

#include <memory>

#include "render/image.h"
#include "scene/frame.h"

namespace navvy::render {

/// Options that hold for all pictures of a Renderer.
struct RenderOptions {
  /// Samples per pixel, 1 or 4; 4 smooths edges and takes two to three times as long.
  int samples = 1;
  /// Draws ground beyond the site's edge, fading into haze; false: the site stands free.
  bool surroundings = true;
  /// Draws the shadows of machines and falling soil on the ground.
  bool shadows = true;
  /// Largest number of ground triangles per picture; the level of detail gets coarser to respect
  /// it.
  int triangle_budget = 40000;
};

/// Cost of the last picture: counts of what was drawn, and wall time of the host [ms].
struct RenderStats {
  int ground_triangles = 0, ground_tiles = 0;
  int particles_drawn = 0, particle_triangles = 0;
  int tiles_rebuilt = 0;
  /// Time to prepare ground, shadows and particles, and time to draw [ms].
  double prepare_ms = 0, draw_ms = 0;
};

/// Draws ground, soil particles, machines, sky and shadows with Coin3D and OSMesa.
///
/// The same frame gives the same bytes on one Mesa version. One Renderer at a time per process,
/// used from the thread that created it (Coin is not thread-safe). The ground is cached: a picture
/// costs what changed and what the camera sees.
class Renderer {
 public:
  /// Creates the drawing context. @throws Error when no context can be created.
  explicit Renderer(const RenderOptions& options = {});
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Draws `frame` as `camera` sees it; `depth`, when given, receives the depth picture of the same
  /// size. The ground's changed rectangles are trusted when its revision follows the last one
  /// drawn; otherwise heights are compared. @throws FileError or InputError naming a mesh file that
  /// cannot be read, Error for an impossible picture size.
  Image render(const scene::Frame& frame, const scene::FrameCamera& camera,
               DepthImage* depth = nullptr);

  /// Returns the cost of the last picture; zeros before the first.
  const RenderStats& stats() const;

  // Coin's and GL's headers stay in the source.
 private:
  // Keeps the headers of Coin and GL in the source.
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace navvy::render
