// SPDX-License-Identifier: Apache-2.0
// Draws a scene::Frame off-screen, without a display.
#pragma once

#include <memory>

#include "render/image.h"
#include "scene/frame.h"

namespace navvy::render {

/// Options that apply to all pictures of a Renderer.
struct RenderOptions {
  /// True to draw ground beyond the edge of the site, which fades into haze; false to draw only the
  /// site.
  bool surroundings = true;
  /// True to draw the shadows of machines and falling soil on the ground.
  bool shadows = true;
  /// True to draw dumped soil at smoothed heights; false for pictures from which heights are
  /// measured.
  bool smooth = true;
  /// Maximum number of ground triangles per picture (approximate). The level of detail is reduced
  /// to respect it.
  int triangle_budget = 40000;
};

/// Numbers of drawn objects in one picture, and the wall time it took.
struct RenderStats {
  /// Number of triangles and of tiles drawn for the ground.
  int ground_triangles = 0, ground_tiles = 0;
  /// Number of soil particles drawn as single lumps, and of their triangles.
  int particles_drawn = 0, particle_triangles = 0;
  /// Number of triangles of the surface of loose soil.
  int soil_triangles = 0;
  /// Number of tiles whose mesh had to be built for this picture.
  int tiles_rebuilt = 0;
  /// Wall time to prepare ground, shadows and particles (`prepare_ms`), and wall time to draw
  /// (`draw_ms`) [ms].
  double prepare_ms = 0, draw_ms = 0;
  /// Part of `prepare_ms` that the surface of loose soil took [ms].
  double soil_ms = 0;
};

/// Draws ground, soil particles, machines, sky and shadows with Coin3D and OSMesa.
///
/// The same frame gives bit-identical pictures with the same version of Mesa. All
/// calls to all renderers of a process must come from one thread, because Coin is not thread-safe.
/// The mesh of the ground is cached, so the cost of a picture depends on the area that has changed
/// and on what the camera sees.
class Renderer {
 public:
  /// Creates the OpenGL context. @throws Error if that fails.
  explicit Renderer(const RenderOptions& options = {});
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Returns a picture of `frame` as seen by `camera`. If `depth` is not null, it receives the
  /// depth picture of the same size.
  ///
  /// If the revision of the ground directly follows the one drawn last, only the rectangles that
  /// the frame marks as changed are updated; otherwise all heights are compared. @throws FileError
  /// or InputError with the name of a mesh file that cannot be read, Error if the picture size is
  /// not supported.
  Image render(const scene::Frame& frame, const scene::FrameCamera& camera,
               DepthImage* depth = nullptr);

  /// Returns the statistics of the last picture; all zero before the first one.
  const RenderStats& stats() const;

 private:
  // Hides the headers of Coin and OpenGL from users of this class.
  class Impl;
  // Implementation and all cached data.
  std::unique_ptr<Impl> impl_;
};

}  // namespace navvy::render
