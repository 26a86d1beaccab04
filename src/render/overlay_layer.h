// SPDX-License-Identifier: Apache-2.0
// Lines and labels that are drawn over a picture.
#pragma once

#include <string>

#include "render/view.h"
#include "scene/frame.h"

class SoCamera;
class SoSeparator;

namespace navvy::render {

/// Scene graph of a frame's overlay. Text has the font that Coin contains, so that pictures do not
/// depend on the fonts of a machine. All calls must come from the thread of the renderer.
class OverlayLayer {
 public:
  /// Makes an empty graph that is seen through `camera`.
  explicit OverlayLayer(SoCamera* camera);
  ~OverlayLayer();
  OverlayLayer(const OverlayLayer&) = delete;
  OverlayLayer& operator=(const OverlayLayer&) = delete;

  /// Replaces the content by that of `overlay`, for a picture with the projection `view`.
  void set(const scene::FrameOverlay& overlay, const View& view);
  /// Returns the root of the graph, to be drawn after everything else.
  SoSeparator* root() const { return root_; }

 private:
  /// Adds a line.
  void add(const scene::FrameLine& line);
  /// Adds a text whose lower left corner is at `p_W`, over a dark copy of itself.
  void add(const std::string& text, const Vec3& p_W, const scene::Color& color, const View& view);

  // Root of the graph, and the part of it that `set` replaces.
  SoSeparator *root_, *content_;
};

}  // namespace navvy::render
