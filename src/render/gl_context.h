// SPDX-License-Identifier: Apache-2.0
// The OpenGL context, isolated in one class so that another one (EGL, a GPU) can replace it.
#pragma once

#include <cstdint>
#include <vector>

namespace navvy::render {

/// An off-screen OSMesa context with its own colour buffer (RGBA, 8 bits per channel) and a depth
/// buffer of 24 bits. Rows are stored from bottom to top.
///
/// Not thread-safe: use the context only in the thread that created it. One context serves pictures
/// of different sizes.
class GlContext {
 public:
  /// Creates the context; `begin` allocates the buffers. @throws Error if OSMesa cannot create a
  /// context.
  GlContext();
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  /// Makes the context current and prepares a picture of width x height pixels. If `samples` is
  /// greater than 1, everything is drawn into a multisample buffer with that number of samples per
  /// pixel, which `finish` resolves. @throws Error if the size or the number of samples is not
  /// supported.
  void begin(int width, int height, int samples);
  /// Completes the picture. Afterwards `pixels` returns it.
  void finish();
  /// Returns the depth buffer of the picture being drawn, one value in 0..1 per pixel, rows from
  /// bottom to top. Call it before `finish`.
  std::vector<float> depth() const;
  /// Returns the last finished picture, four bytes (RGBA) per pixel, rows from bottom to top. Valid
  /// until the next `begin`.
  const std::vector<std::uint8_t>& pixels() const { return pixels_; }

 private:
  /// Creates the multisample buffers if necessary, and makes them the target of drawing.
  void bind_multisample(int samples);
  /// Frees the multisample buffers.
  void release_multisample();

  // The OSMesaContext.
  void* context_ = nullptr;
  // Colour buffer, into which OSMesa draws directly.
  std::vector<std::uint8_t> pixels_;
  // Size of the current picture [pixels].
  int width_ = 0, height_ = 0;
  // OpenGL names of the multisample framebuffer and of its two renderbuffers; 0 if there are none.
  unsigned frame_ = 0, color_ = 0, depth_ = 0;
  // Size [pixels] and samples per pixel of the multisample buffers.
  int buffer_width_ = 0, buffer_height_ = 0, buffer_samples_ = 0;
};

}  // namespace navvy::render
