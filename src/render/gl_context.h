// SPDX-License-Identifier: Apache-2.0
// The drawing context in one small class, so that another way to reach GL (EGL, hardware) replaces
// one file.
#pragma once

#include <cstdint>
#include <vector>

namespace navvy::render {

/// An OSMesa context with its own colour buffer, RGBA 8 bits, depth 24 bits, bottom row first.
///
/// Not thread-safe: use it from the thread that created it. Several buffer sizes share one context.
class GlContext {
 public:
  /// Creates the context only; `begin` allocates memory for pictures. @throws Error when OSMesa
  /// provides no context.
  GlContext();
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  /// Makes the context current with a buffer of width x height pixels. With `samples` > 1
  /// everything is drawn into a multisample buffer until `finish`. @throws Error when the size is
  /// refused.
  void begin(int width, int height, int samples);
  /// Ends drawing; afterwards `pixels` holds the picture.
  void finish();
  /// Returns the depth buffer of the current picture in 0..1, bottom row first; call it before
  /// `finish`.
  std::vector<float> depth() const;
  /// Returns the last finished picture, valid until the next `begin`.
  const std::vector<std::uint8_t>& pixels() const { return pixels_; }

 private:
  // Creates and binds the multisample buffers; release_multisample frees them.
  void bind_multisample(int samples);
  void release_multisample();

  void* context_ = nullptr;
  // The colour buffer into which OSMesa draws directly.
  std::vector<std::uint8_t> pixels_;
  int width_ = 0, height_ = 0;
  // Multisample buffers; 0: none.
  unsigned frame_ = 0, color_ = 0, depth_ = 0;
  int buffer_width_ = 0, buffer_height_ = 0, buffer_samples_ = 0;
};

}  // namespace navvy::render
