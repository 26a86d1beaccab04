// SPDX-License-Identifier: Apache-2.0
#include "render/gl_context.h"

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
#include <GL/osmesa.h>

#include <string>

#include "core/error.h"

namespace navvy::render {

GlContext::GlContext() {
  // Coin draws with the fixed-function pipeline, hence the compatibility profile. No stencil:
  // nothing here uses one, and it would cost memory for every pixel.
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_DEPTH_BITS,
                            24,
                            OSMESA_STENCIL_BITS,
                            0,
                            OSMESA_PROFILE,
                            OSMESA_COMPAT_PROFILE,
                            0};
  context_ = OSMesaCreateContextAttribs(attributes, nullptr);
  if (context_ == nullptr)
    throw Error("OSMesa created no drawing context (is libosmesa6 complete?)");
}

GlContext::~GlContext() {
  // The buffers belong to the context, so they are released before it, and in it: that of another
  // renderer may be the current one.
  if (frame_ != 0 && OSMesaMakeCurrent(static_cast<OSMesaContext>(context_), pixels_.data(),
                                       GL_UNSIGNED_BYTE, width_, height_) != 0)
    release_multisample();
  OSMesaDestroyContext(static_cast<OSMesaContext>(context_));
}

void GlContext::begin(int width, int height, int samples) {
  // Mesa draws at most 16384 pixels per side; checked here, the error names the size.
  if (width <= 0 || height <= 0 || width > 16384 || height > 16384)
    throw Error("a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                " pixels cannot be drawn (allowed: 1 to 16384 per side)");
  // OSMesa draws into this memory, so it is made current again whenever the vector may have been
  // reallocated.
  pixels_.resize(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  if (OSMesaMakeCurrent(static_cast<OSMesaContext>(context_), pixels_.data(), GL_UNSIGNED_BYTE,
                        width, height) == 0)
    throw Error("OSMesa refuses a buffer of " + std::to_string(width) + " x " +
                std::to_string(height) + " pixels");
  width_ = width;
  height_ = height;
  if (samples > 1) bind_multisample(samples);
  glViewport(0, 0, width, height);
}

void GlContext::bind_multisample(int samples) {
  // Kept between pictures, as several cameras of one size often follow each other.
  if (frame_ != 0 &&
      (buffer_width_ != width_ || buffer_height_ != height_ || buffer_samples_ != samples))
    release_multisample();
  if (frame_ == 0) {
    glGenFramebuffers(1, &frame_);
    glGenRenderbuffers(1, &color_);
    glGenRenderbuffers(1, &depth_);
    glBindRenderbuffer(GL_RENDERBUFFER, color_);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_RGBA8, width_, height_);
    glBindRenderbuffer(GL_RENDERBUFFER, depth_);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_DEPTH_COMPONENT24, width_,
                                     height_);
    glBindFramebuffer(GL_FRAMEBUFFER, frame_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
    buffer_width_ = width_;
    buffer_height_ = height_;
    buffer_samples_ = samples;
  }
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    release_multisample();
    throw Error("the drawing context has no buffer with " + std::to_string(samples) +
                " samples a pixel");
  }
  glEnable(GL_MULTISAMPLE);
}

void GlContext::release_multisample() {
  if (frame_ == 0) return;
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glDeleteFramebuffers(1, &frame_);
  glDeleteRenderbuffers(1, &color_);
  glDeleteRenderbuffers(1, &depth_);
  frame_ = color_ = depth_ = 0;
}

std::vector<float> GlContext::depth() const {
  std::vector<float> out(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  // Rows without padding, for any width.
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_DEPTH_COMPONENT, GL_FLOAT, out.data());
  return out;
}

void GlContext::finish() {
  GLint bound = 0;
  // Resolves the samples of each pixel; without multisampling the buffer already holds the picture.
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
  if (bound != 0) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
  }
  // OSMesa has written the pixels into our memory when this call returns.
  glFinish();
}

}  // namespace navvy::render
