// SPDX-License-Identifier: Apache-2.0
#include "render/gl_draw.h"

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

#include <algorithm>
#include <array>

namespace navvy::render {
namespace {

// Size of the texture [texels].
constexpr int kGrainSize = 256;
// Length that the texture covers before it repeats [m].
constexpr float kGrainLength = 2.2f;

/// Returns noise that repeats after `period` lattice cells. It comes from an integer hash, so that
/// a picture is the same on every machine.
float periodic_noise(float x, float y, int period, std::uint32_t seed) {
  const int ix = static_cast<int>(std::floor(x)), iy = static_cast<int>(std::floor(y));
  const float tx = smooth_step(0, 1, x - static_cast<float>(ix)),
              ty = smooth_step(0, 1, y - static_cast<float>(iy));
  const auto at = [&](int kx, int ky) {
    return hash_unit(static_cast<std::uint32_t>(kx % period),
                     static_cast<std::uint32_t>(ky % period), seed);
  };
  const float low = at(ix, iy) + (at(ix + 1, iy) - at(ix, iy)) * tx;
  const float high = at(ix, iy + 1) + (at(ix + 1, iy + 1) - at(ix, iy + 1)) * tx;
  return 2 * (low + (high - low) * ty) - 1;
}

/// Returns a square picture of `size` x `size` texels at half its size: means of four texels each.
std::vector<std::uint8_t> half_size(const std::vector<std::uint8_t>& texels, std::size_t size) {
  const std::size_t half = size / 2;
  std::vector<std::uint8_t> out(half * half);
  for (std::size_t y = 0; y < half; ++y)
    for (std::size_t x = 0; x < half; ++x) {
      const std::size_t i = 2 * y * size + 2 * x;
      const int sum = texels[i] + texels[i + 1] + texels[i + size] + texels[i + size + 1];
      out[y * half + x] = static_cast<std::uint8_t>((sum + 2) / 4);
    }
  return out;
}

void set_plane(GLenum coordinate, const Eigen::Vector4f& plane) {
  glTexGeni(coordinate, GL_TEXTURE_GEN_MODE, GL_OBJECT_LINEAR);
  glTexGenfv(coordinate, GL_OBJECT_PLANE, plane.data());
}

void elements(const std::vector<std::uint32_t>& indices) {
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(indices.size()), GL_UNSIGNED_INT,
                 indices.data());
}

void set_enabled(GLenum what, bool on) {
  if (on)
    glEnable(what);
  else
    glDisable(what);
}

void use_vertices(const Mesh& mesh) {
  glVertexPointer(3, GL_FLOAT, sizeof(Vertex), &mesh.vertices[0].x);
  glColorPointer(4, GL_UNSIGNED_BYTE, sizeof(Vertex), &mesh.vertices[0].r);
}

// Draws a tile. Skirts hang from the edges of tiles and hide gaps between levels of detail.
void draw(const Mesh& mesh, const std::array<bool, 4>& skirts = {}) {
  if (mesh.indices.empty()) return;
  use_vertices(mesh);
  elements(mesh.indices);
  if (std::none_of(skirts.begin(), skirts.end(), [](bool on) { return on; })) return;
  glShadeModel(GL_FLAT);
  for (std::size_t k = 0; k < 4; ++k)
    if (skirts[k]) elements(mesh.skirts[k]);
  glShadeModel(GL_SMOOTH);
}

/// Returns true if any point of the box is at least `distance` from the camera. The farthest corner
/// of the box decides.
bool reaches_beyond(const GroundPart& part, const Vec3f& eye, float distance) {
  return (part.low - eye).cwiseAbs().cwiseMax((part.high - eye).cwiseAbs()).norm() >= distance;
}

}  // namespace

void GlDraw::begin(const View& view, const Lighting& lighting) {
  // Coin keeps its own record of the GL state and would not notice a change, so all of it is saved
  // here and restored by end().
  glPushAttrib(GL_ALL_ATTRIB_BITS);
  glPushClientAttrib(GL_CLIENT_ALL_ATTRIB_BITS);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
  glMatrixMode(GL_PROJECTION);
  glPushMatrix();
  glLoadMatrixd(view.projection.data());
  glMatrixMode(GL_MODELVIEW);
  glPushMatrix();
  glLoadMatrixd(view.model_view.data());
  glDisable(GL_LIGHTING);
  glDisable(GL_TEXTURE_2D);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glShadeModel(GL_SMOOTH);
  glEnableClientState(GL_VERTEX_ARRAY);
  glEnableClientState(GL_COLOR_ARRAY);
  glDisableClientState(GL_NORMAL_ARRAY);
  glDepthMask(GL_TRUE);
  glEnable(GL_DEPTH_TEST);
  // The sky is drawn at the far end of the depth range, so equal depths must pass.
  glDepthFunc(GL_LEQUAL);
  glClearColor(lighting.haze.x(), lighting.haze.y(), lighting.haze.z(), 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  // Haze has the colour of the horizon, so that distant objects fade into the sky.
  const GLfloat fog[] = {lighting.haze.x(), lighting.haze.y(), lighting.haze.z(), 1};
  glFogi(GL_FOG_MODE, GL_LINEAR);
  glFogf(GL_FOG_START, kFogStart);
  glFogf(GL_FOG_END, kFogEnd);
  glFogfv(GL_FOG_COLOR, fog);
}

// A dome around the camera, drawn only where the picture is empty: haze at the horizon, blue above,
// a glow around the sun.
void GlDraw::sky(const View& view, const Lighting& lighting) {
  constexpr int kSides = 40, kRings = 18;
  Mesh dome;
  for (int r = 0; r <= kRings; ++r)
    for (int i = 0; i <= kSides; ++i) {
      const float t = static_cast<float>(r) / kRings;
      // Rings lie closer together near the horizon, where the colours change most; the dome reaches
      // a little below it.
      const float up = -0.3f + 1.87f * t * t,
                  a = 2 * static_cast<float>(kPi) * static_cast<float>(i) / kSides;
      const Vec3f ray(std::cos(up) * std::cos(a), std::cos(up) * std::sin(a), std::sin(up));
      const float blue = std::pow(std::clamp(ray.z(), 0.0f, 1.0f), 0.55f);
      const float glow = std::pow(std::max(0.0f, ray.dot(lighting.to_sun)), 12.0f);
      Vec3f color = lighting.haze + (lighting.zenith - lighting.haze) * blue;
      color += (Vec3f(1.0f, 0.97f, 0.88f) - color) * 0.45f * glow;
      // The radius does not matter, as the dome is moved to the far end of the depth range; it only
      // has to be between the clipping planes.
      const Vec3f p = view.eye + 100.0f * ray;
      dome.vertices.push_back(
          {p.x(), p.y(), p.z(), to_byte(color.x()), to_byte(color.y()), to_byte(color.z()), 255});
      if (r == 0 || i == 0) continue;
      const auto c = static_cast<std::uint32_t>(dome.vertices.size() - 1), below = c - (kSides + 1);
      dome.indices.insert(dome.indices.end(), {below - 1, below, c, below - 1, c, c - 1});
    }
  glDisable(GL_FOG);
  glDepthMask(GL_FALSE);
  // Farther than all else.
  glDepthRange(1, 1);
  draw(dome);
  glDepthRange(0, 1);
  glDepthMask(GL_TRUE);
}

void GlDraw::make_grain() {
  // Three octaves, a little noise at every texel and a few pebbles. Made once; it repeats without a
  // seam.
  std::vector<std::uint8_t> texels(kGrainSize * kGrainSize);
  for (int y = 0; y < kGrainSize; ++y)
    for (int x = 0; x < kGrainSize; ++x) {
      const float u = static_cast<float>(x) / kGrainSize, v = static_cast<float>(y) / kGrainSize;
      float tone = 0.045f * periodic_noise(12 * u, 12 * v, 12, 21) +
                   0.06f * periodic_noise(31 * u, 31 * v, 31, 22) +
                   0.07f * periodic_noise(77 * u, 77 * v, 77, 23);
      tone += 0.05f *
              (hash_unit(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 24) - 0.5f);
      const float pebble = periodic_noise(45 * u, 45 * v, 45, 25);
      if (pebble > 0.72f) tone += 0.10f;
      texels[static_cast<std::size_t>(y * kGrainSize + x)] = to_byte(0.5f + tone);
    }
  glGenTextures(1, &grain_);
  glBindTexture(GL_TEXTURE_2D, grain_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  // At a distance the texture fades into its mean: it would flicker, and where a repetition is some
  // pixels long it would draw a lattice on the ground.
  constexpr std::array<float, 4> kContrast = {1, 0.8f, 0.5f, 0.2f};
  std::size_t size = kGrainSize;
  for (int level = 0; size > 0; ++level, size /= 2) {
    const float contrast = static_cast<std::size_t>(level) < kContrast.size()
                               ? kContrast[static_cast<std::size_t>(level)]
                               : 0;
    // Software GL reads four channels faster than one.
    std::vector<std::array<std::uint8_t, 4>> shown(texels.size());
    for (std::size_t i = 0; i < texels.size(); ++i) {
      const std::uint8_t tone =
          to_byte(0.5f + contrast * (static_cast<float>(texels[i]) / 255.0f - 0.5f));
      shown[i] = {tone, tone, tone, 255};
    }
    glTexImage2D(GL_TEXTURE_2D, level, GL_RGBA8, static_cast<GLsizei>(size),
                 static_cast<GLsizei>(size), 0, GL_RGBA, GL_UNSIGNED_BYTE, shown.data());
    texels = half_size(texels, size);
  }
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

// Projects the texture from above, so that the grain stays where soil settles; on walls from the
// side.
void GlDraw::place_grain(bool on_walls) {
  glActiveTexture(GL_TEXTURE0);
  const float k = 1.0f / kGrainLength;
  set_plane(GL_S,
            on_walls ? Eigen::Vector4f(0.9f * k, 0.6f * k, 0, 0) : Eigen::Vector4f(k, 0, 0, 0));
  set_plane(GL_T, on_walls ? Eigen::Vector4f(0, 0, k, 0) : Eigen::Vector4f(0, k, 0, 0));
}

void GlDraw::bind_grain() {
  glActiveTexture(GL_TEXTURE0);
  if (grain_ == 0) make_grain();
  glBindTexture(GL_TEXTURE_2D, grain_);
  glEnable(GL_TEXTURE_2D);
  // Twice the product: the mean of the texture is one half and must leave colours unchanged.
  glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_COMBINE);
  glTexEnvi(GL_TEXTURE_ENV, GL_COMBINE_RGB, GL_MODULATE);
  glTexEnvi(GL_TEXTURE_ENV, GL_RGB_SCALE, 2);
  place_grain(false);
  glEnable(GL_TEXTURE_GEN_S);
  glEnable(GL_TEXTURE_GEN_T);
}

void GlDraw::bind_shadow(const ShadowMap& shadows, const Lighting& lighting) {
  glActiveTexture(GL_TEXTURE1);
  if (shadow_ == 0) glGenTextures(1, &shadow_);
  glBindTexture(GL_TEXTURE_2D, shadow_);
  // The mask is a texture of 512 x 512 texels; it is uploaded only when the casters have moved.
  if (shadow_version_ != shadows.version()) {
    shadow_version_ = shadows.version();
    std::array<std::array<std::uint8_t, 4>, 256> tone;
    for (std::size_t i = 0; i < 256; ++i) {
      const Vec3f lit = shadow_tone(lighting, static_cast<float>(i) / 255.0f);
      tone[i] = {to_byte(lit.x()), to_byte(lit.y()), to_byte(lit.z()), 255};
    }
    std::vector<std::array<std::uint8_t, 4>> texels(shadows.mask().size());
    for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = tone[shadows.mask()[i]];
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, ShadowMap::kSize, ShadowMap::kSize, 0, GL_RGBA,
                 GL_UNSIGNED_BYTE, texels.data());
  }
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  // Everything beyond the map is lit; its margin is kept lit for this reason.
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_MODULATE);
  set_plane(GL_S, shadows.plane_s());
  set_plane(GL_T, shadows.plane_t());
  glEnable(GL_TEXTURE_GEN_S);
  glEnable(GL_TEXTURE_GEN_T);
}

void GlDraw::ground(const std::vector<GroundPart>& parts, const View& view,
                    const ShadowMap& shadows, const Lighting& lighting) {
  bind_grain();
  if (!shadows.empty()) bind_shadow(shadows, lighting);
  // Draws walls after tops, since the texture is projected differently on them and its planes are
  // set once for all tiles.
  for (const bool walls : {false, true}) {
    if (walls) place_grain(true);
    glActiveTexture(GL_TEXTURE1);
    for (const GroundPart& part : parts) {
      if (walls && part.mesh->walls.empty()) continue;
      // A tile that is near or that no shadow reaches is drawn without the texture unit: software
      // GL pays for it at every pixel.
      set_enabled(GL_TEXTURE_2D, !part.shadowed && shadows.reaches(part.low, part.high));
      set_enabled(GL_FOG, reaches_beyond(part, view.eye, kFogStart));
      if (!walls) draw(*part.mesh, part.skirts);
      if (!walls) continue;
      use_vertices(*part.mesh);
      elements(part.mesh->walls);
    }
  }
  // Particles and sky, which follow, have no texture.
  for (const GLenum unit : {GL_TEXTURE1, GL_TEXTURE0}) {
    glActiveTexture(unit);
    glDisable(GL_TEXTURE_2D);
    glDisable(GL_TEXTURE_GEN_S);
    glDisable(GL_TEXTURE_GEN_T);
  }
}

// Closed bodies: their back faces are never visible.
void GlDraw::lumps(const Mesh& mesh) {
  glEnable(GL_FOG);
  glEnable(GL_CULL_FACE);
  draw(mesh);
  glDisable(GL_CULL_FACE);
}

void GlDraw::end() {
  glMatrixMode(GL_PROJECTION);
  glPopMatrix();
  glMatrixMode(GL_MODELVIEW);
  glPopMatrix();
  // Attributes are restored last, as they hold the matrix mode.
  glPopClientAttrib();
  glPopAttrib();
}

}  // namespace navvy::render
