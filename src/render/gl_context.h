// SPDX-License-Identifier: Apache-2.0
// The drawing context behind one small class, so that another road to GL (EGL, hardware) replaces
// one file.
#pragma once

#include <cstdint>
#include <vector>

namespace navvy::render {

/// An OSMesa context with an own colour buffer, RGBA 8 bits, depth 24 bits, bottom row first.
///
/// Not thread-safe: use it from the thread that made it. Several buffer sizes share the one
/// context.
class GlContext {
 public:
  /// Takes the context only; memory for pictures comes with `begin`.
  /// @throws Error when OSMesa gives no context.
  GlContext();
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  /// Makes the context current with a buffer of width x height pixels. With `samples` > 1
  /// everything drawn goes into a multisample buffer until `resolve`. @throws Error when the size
  /// is refused.
  void begin(int width, int height, int samples);
  /// Ends drawing; afterwards `pixels` hold the picture.
  void finish();
  /// Depth buffer values in 0..1 of the current picture, bottom row first; call before `finish`.
  std::vector<float> depth() const;
  /// The picture that `finish` ended, until the next `begin`.
  const std::vector<std::uint8_t>& pixels() const { return pixels_; }

 private:
  // The two that make and drop the buffers of several samples.
  void bind_multisample(int samples);
  void release_multisample();

  void* context_ = nullptr;
  // OSMesa draws straight into it.
  std::vector<std::uint8_t> pixels_;
  int width_ = 0, height_ = 0;
  unsigned frame_ = 0, color_ = 0, depth_ = 0;  ///< multisample buffers; 0: none
  int buffer_width_ = 0, buffer_height_ = 0, buffer_samples_ = 0;
};

}  // namespace navvy::render
