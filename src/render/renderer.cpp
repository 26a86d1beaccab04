// SPDX-License-Identifier: Apache-2.0
#include "render/renderer.h"

#include <Inventor/SoDB.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/elements/SoGLCacheContextElement.h>
#include <Inventor/nodes/SoCallback.h>
#include <Inventor/nodes/SoDirectionalLight.h>
#include <Inventor/nodes/SoEnvironment.h>
#include <Inventor/nodes/SoMatrixTransform.h>
#include <Inventor/nodes/SoPerspectiveCamera.h>
#include <Inventor/nodes/SoSeparator.h>

#include <limits>
#include <mutex>

#include "core/error.h"
#include "core/stopwatch.h"
#include "render/body_shader.h"
#include "render/body_shadows.h"
#include "render/gl_context.h"
#include "render/gl_draw.h"
#include "render/overlay_layer.h"
#include "render/particle_mesh.h"
#include "render/shape_cache.h"
#include "render/soil_surface.h"
#include "render/terrain_mesh.h"

#include <Inventor/system/gl.h>

namespace navvy::render {
namespace {

SbColor to_coin(const Vec3f& c) { return {c.x(), c.y(), c.z()}; }

// Converts a matrix for Coin, transposed as explained below.
SbMatrix to_coin(const Eigen::Matrix4f& m) {
  // Coin multiplies row vectors from the left.
  SbMatrix out;
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) out[r][c] = m(c, r);
  return out;
}

/// Returns the affine map that places the unit body (x from 0 to 1, radius 1) from `from` along
/// `axis`. The two other axes may turn about it, as the body is round.
Eigen::Matrix4f stretch(const Vec3& from, const Vec3& axis, double length, double radius) {
  const Vec3 side = axis.unitOrthogonal();
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.block<3, 1>(0, 0) = axis * length;
  m.block<3, 1>(0, 1) = side * radius;
  m.block<3, 1>(0, 2) = axis.cross(side) * radius;
  m.block<3, 1>(0, 3) = from;
  return m.cast<float>();
}

/// Returns a node that draws a body at its place.
SoSeparator* node_of(const PlacedShape& body) {
  auto* node = new SoSeparator;
  node->renderCaching = SoSeparator::OFF;
  node->renderCulling = SoSeparator::OFF;
  auto* transform = new SoMatrixTransform;
  transform->matrix = to_coin(body.X_WS);
  node->addChild(transform);
  node->addChild(body.shape->node);
  return node;
}

/// Returns distances along the camera's axis from the depth buffer, whose first row is the bottom
/// one and whose scale is finer near the camera.
DepthImage depth_image(const std::vector<float>& raw, int width, int height) {
  const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
  DepthImage out;
  out.width = width;
  out.height = height;
  out.depth.resize(w * h);
  constexpr double kNear = View::kNear, kFar = View::kFar;
  for (std::size_t y = 0; y < h; ++y)
    for (std::size_t x = 0; x < w; ++x) {
      const float d = raw[(h - 1 - y) * w + x];
      out.depth[y * w + x] = d >= 1.0f
                                 ? std::numeric_limits<float>::infinity()
                                 : static_cast<float>(kNear * kFar / (kFar - d * (kFar - kNear)));
    }
  return out;
}

/// Returns the picture of RGBA pixels, whose first row is the bottom one.
Image color_image(const std::uint8_t* pixels, int width, int height) {
  const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
  Image image{width, height, {}};
  image.rgb.resize(3 * w * h);
  for (std::size_t y = 0; y < h; ++y) {
    const std::uint8_t* in = pixels + 4 * w * (h - 1 - y);
    std::uint8_t* out = image.rgb.data() + 3 * w * y;
    for (std::size_t x = 0; x < w; ++x, in += 4, out += 3) {
      out[0] = in[0];
      out[1] = in[1];
      out[2] = in[2];
    }
  }
  return image;
}

}  // namespace

class Renderer::Impl {
 public:
  explicit Impl(const RenderOptions& options);
  ~Impl();
  Image render(const scene::Frame& frame, const scene::FrameCamera& camera, DepthImage* depth);
  RenderStats stats;

 private:
  void place(const scene::Frame& frame);
  void cast_shadows(const scene::Frame& frame, const Lighting& lighting);
  /// Sets Coin's camera and lights.
  void set_view(const View& view, const scene::FrameCamera& camera, const Lighting& lighting);
  void draw_machines(const View& view, const scene::FrameCamera& camera, const Lighting& lighting);
  void draw_overlay(const View& view, const scene::FrameOverlay& overlay);
  SoDirectionalLight* add_light();

  RenderOptions options_;
  GlContext context_;
  GlDraw draw_;
  TerrainMesh terrain_;
  BodyShadows shadows_;
  BodyShader shader_;
  SoilSurface soil_;
  ParticleMesh particles_;
  ShapeCache shapes_;
  std::vector<PlacedShape> placed_;
  SoSeparator* root_ = nullptr;
  SoPerspectiveCamera* camera_ = nullptr;
  SoEnvironment* environment_ = nullptr;
  SoDirectionalLight *sun_ = nullptr, *sky_ = nullptr, *bounce_ = nullptr;
  SoSeparator* machines_ = nullptr;
  std::unique_ptr<OverlayLayer> overlay_;
  std::uint32_t cache_context_ = 0;
};

Renderer::Impl::Impl(const RenderOptions& options) : options_(options), terrain_(options.smooth) {
  // Once per process, by the first renderer.
  static std::once_flag started;
  std::call_once(started, [] { SoDB::init(); });
  // Coin keeps display lists by context; a context id per renderer keeps their lists apart.
  cache_context_ = SoGLCacheContextElement::getUniqueCacheContext();
  root_ = new SoSeparator;
  root_->ref();
  // Everything below changes with each picture, so a cache would be rebuilt each time.
  root_->renderCaching = SoSeparator::OFF;
  camera_ = new SoPerspectiveCamera;
  // The aspect ratio is set with the size of each picture; Coin must not adapt it to the viewport.
  camera_->viewportMapping = SoCamera::LEAVE_ALONE;
  root_->addChild(camera_);
  environment_ = new SoEnvironment;
  root_->addChild(environment_);
  sun_ = add_light();
  sky_ = add_light();
  bounce_ = add_light();
  machines_ = new SoSeparator;
  machines_->renderCaching = SoSeparator::OFF;
  root_->addChild(machines_);
  overlay_ = std::make_unique<OverlayLayer>(camera_);
}

Renderer::Impl::~Impl() {
  overlay_.reset();
  root_->unref();
}

SoDirectionalLight* Renderer::Impl::add_light() {
  auto* light = new SoDirectionalLight;
  root_->addChild(light);
  return light;
}

void Renderer::Impl::place(const scene::Frame& frame) {
  placed_.clear();
  for (const scene::FrameShape& shape : frame.shapes)
    if (shape.visual != nullptr)
      placed_.push_back({&shapes_.get(*shape.visual), shape.X_WV.matrix().cast<float>()});
  for (const scene::FrameCylinder& c : frame.cylinders) {
    const double length = (c.p_rod - c.p_base).norm();
    // A fully retracted cylinder has no axis to draw along.
    if (!(length > 1e-6)) continue;
    const Vec3 axis = (c.p_rod - c.p_base) / length;
    const double barrel = std::clamp(c.barrel_length, 0.0, length);
    placed_.push_back(
        {&shapes_.cylinder_along_x(false), stretch(c.p_base, axis, barrel, c.radius)});
    placed_.push_back(
        {&shapes_.cylinder_along_x(true), stretch(c.p_base, axis, length, 0.55 * c.radius)});
  }
}

void Renderer::Impl::cast_shadows(const scene::Frame& frame, const Lighting& lighting) {
  if (!options_.shadows) return shadows_.clear(placed_, lighting);
  // Only soil in the air casts a shadow here; soil on the ground would only darken the ground right
  // below it.
  const std::vector<float>& xyz = frame.particles.position;
  const Vec3f origin = frame.particles.origin.cast<float>();
  std::vector<Vec3f> falling;
  for (std::size_t i = 0; i + 2 < xyz.size(); i += 3) {
    const Vec3f p = origin + Vec3f(xyz[i], xyz[i + 1], xyz[i + 2]);
    float height = 0, sun = 1;
    // 0.3 m above the ground counts as falling. Beyond the site there is no ground to cast a shadow
    // on.
    if (!p.allFinite() || !terrain_.surface().sample(p.x(), p.y(), height, sun) ||
        p.z() < height + 0.3f)
      continue;
    falling.push_back(p);
  }
  shadows_.update(placed_, falling, static_cast<float>(frame.particles.radius), lighting);
}

void Renderer::Impl::set_view(const View& view, const scene::FrameCamera& camera,
                              const Lighting& lighting) {
  const Eigen::Quaternionf q(camera.X_WC.linear().cast<float>());
  camera_->position = SbVec3f(view.eye.x(), view.eye.y(), view.eye.z());
  camera_->orientation = SbRotation(q.x(), q.y(), q.z(), q.w());
  camera_->aspectRatio = static_cast<float>(view.width) / static_cast<float>(view.height);
  camera_->heightAngle = static_cast<float>(2 * std::atan(view.tan_y));
  camera_->nearDistance = static_cast<float>(View::kNear);
  camera_->farDistance = static_cast<float>(View::kFar);
  // Three lights and an ambient part imitate the sky and the light from the ground, so that bodies
  // drawn by Coin match the ground lit by shading.h.
  environment_->ambientIntensity = 1.0f;
  environment_->ambientColor = to_coin(Vec3f(0.62f * (lighting.sky + lighting.ground)));
  environment_->fogType = SoEnvironment::HAZE;
  environment_->fogColor = to_coin(lighting.haze);

  environment_->fogVisibility = 2 * GlDraw::kFogEnd;  // Coin's haze starts at the camera
  sun_->direction = SbVec3f(-lighting.to_sun.x(), -lighting.to_sun.y(), -lighting.to_sun.z());
  sun_->color = to_coin(lighting.sun);
  sky_->direction = SbVec3f(0.25f * lighting.to_sun.x(), 0.25f * lighting.to_sun.y(), -1);
  sky_->color = to_coin(lighting.sky);
  sky_->intensity = 0.55f;
  bounce_->direction = SbVec3f(lighting.to_sun.x(), lighting.to_sun.y(), 0.35f);
  bounce_->color = to_coin(Vec3f(lighting.ground + 0.3f * lighting.sky));
  bounce_->intensity = 1.0f;
}

void Renderer::Impl::draw_machines(const View& view, const scene::FrameCamera& camera,
                                   const Lighting& lighting) {
  machines_->removeAllChildren();
  const Eigen::Matrix4f X_CW =
      Eigen::Map<const Eigen::Matrix4d>(view.model_view.data()).cast<float>();
  // Called by Coin before it draws the bodies of a group, and again before transparent ones.
  struct Lit {
    BodyShader* shader;
    const ShadowMap* shadows;
    const Eigen::Matrix4f* X_CW;
  };
  std::vector<Lit> lit;
  lit.reserve(shadows_.groups().size());
  for (const BodyShadows::Group& group : shadows_.groups()) {
    auto* together = new SoSeparator;
    together->renderCaching = SoSeparator::OFF;
    lit.push_back({&shader_, group.shadows, &X_CW});
    auto* before = new SoCallback;
    before->setCallback(
        [](void* data, SoAction*) {
          const Lit& one = *static_cast<const Lit*>(data);
          one.shader->use(*one.shadows, *one.X_CW);
        },
        &lit.back());
    together->addChild(before);
    for (const std::size_t b : group.bodies) together->addChild(node_of(placed_[b]));
    machines_->addChild(together);
  }
  set_view(view, camera, lighting);
  SoGLRenderAction action(
      SbViewportRegion(static_cast<short>(view.width), static_cast<short>(view.height)));
  action.setCacheContext(cache_context_);
  action.setTransparencyType(SoGLRenderAction::SORTED_OBJECT_BLEND);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_NORMALIZE);
  action.apply(root_);
  shader_.stop();
  // The callbacks refer to this call.
  machines_->removeAllChildren();
}

void Renderer::Impl::draw_overlay(const View& view, const scene::FrameOverlay& overlay) {
  if (overlay.empty()) return;
  overlay_->set(overlay, view);
  SoGLRenderAction action(
      SbViewportRegion(static_cast<short>(view.width), static_cast<short>(view.height)));
  action.setCacheContext(cache_context_);
  action.apply(overlay_->root());
}

Image Renderer::Impl::render(const scene::Frame& frame, const scene::FrameCamera& camera,
                             DepthImage* depth) {
  const Stopwatch watch;
  // A depth picture is read from the plain buffer.
  context_.begin(camera.width, camera.height, depth != nullptr ? 1 : camera.samples);
  const View view(camera);
  const Lighting lighting = make_lighting(frame.lights);
  // The ground is updated first: its surface determines which particles are falling and how the sun
  // reaches them.
  terrain_.update(frame.ground, lighting);
  const std::size_t known = shapes_.size();
  place(frame);
  cast_shadows(frame, lighting);
  std::vector<GroundPart> tiles = terrain_.select(view, options_.triangle_budget);
  stats = {};
  stats.ground_tiles = static_cast<int>(tiles.size());
  if (options_.surroundings && !frame.ground.height.empty())
    tiles.push_back(terrain_.surroundings(lighting));
  for (const GroundPart& tile : tiles) stats.ground_triangles += static_cast<int>(tile.triangles());
  const double before_soil = watch.seconds();
  const Mesh& soil = soil_.build(frame, lighting, shadows_.ground(), terrain_.surface());
  if (!soil.vertices.empty()) tiles.push_back(soil_.part());
  stats.soil_triangles = static_cast<int>((soil.indices.size() + soil.walls.size()) / 3);
  stats.soil_ms = 1e3 * (watch.seconds() - before_soil);
  const Mesh& lumps =
      particles_.build(frame, lighting, shadows_.ground(), terrain_.surface(), view, soil_.lone());
  stats.particles_drawn = particles_.drawn();
  stats.particle_triangles = static_cast<int>(lumps.indices.size() / 3);
  stats.tiles_rebuilt = terrain_.rebuilt();
  stats.prepare_ms = 1e3 * watch.seconds();

  // Coin's first drawing of a body differs by rounding, so new bodies are drawn once and discarded.
  if (shapes_.size() != known) draw_machines(view, camera, lighting);
  // Ground first, as it hides most of the sky; machines last, because Coin blends transparent parts
  // over the rest.
  draw_.begin(view, lighting);
  draw_.ground(tiles, view, shadows_.ground(), lighting);
  draw_.lumps(lumps);
  draw_.sky(view, lighting);
  draw_.end();
  draw_machines(view, camera, lighting);
  draw_overlay(view, frame.overlay);

  if (depth != nullptr) *depth = depth_image(context_.depth(), view.width, view.height);
  context_.finish();
  Image image = color_image(context_.pixels().data(), view.width, view.height);
  stats.draw_ms = 1e3 * watch.seconds() - stats.prepare_ms;
  return image;
}

Renderer::Renderer(const RenderOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Renderer::~Renderer() = default;

Image Renderer::render(const scene::Frame& frame, const scene::FrameCamera& camera,
                       DepthImage* depth) {
  return impl_->render(frame, camera, depth);
}

const RenderStats& Renderer::stats() const { return impl_->stats; }

}  // namespace navvy::render
