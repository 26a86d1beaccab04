// SPDX-License-Identifier: Apache-2.0
// A frame holds what a renderer needs: poses of visuals, cylinders between their pins, a dense
// window of the ground and the particles, all in W.
#include "sim/frame_builder.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "sim/camera_framing.h"
#include "sim/cylinder_shapes.h"
#include "sim/particle_clipper.h"
#include "sim/world_parts.h"
#include "sim/world_terrain.h"

namespace navvy::sim {
namespace {

// Loose soil is drawn as particles, so the ground below it is that of the columns.
constexpr heightfield::SurfaceKind kDrawn = heightfield::SurfaceKind::kColumns;
constexpr int kWindow = 1024;  // columns along one side of the drawn ground
// Smallest distance of a drawn lump's centre from steel, in its radius.
constexpr double kOffPlates = 1.1;
constexpr int kShades = 16;          // colors of the scale from low to high values
constexpr double kFullSpeed = 1.0;   // speed at the upper end of the scale [m/s]
constexpr double kFullChange = 0.5;  // cut or fill at the upper end of its scale [m]

/// Returns the color of a value from 0 to 1: blue, green, yellow, red.
scene::Color shade(double value) {
  const auto peak = [value](double at) {
    return static_cast<float>(std::clamp(1.5 - 4 * std::abs(value - at), 0.05, 0.9));
  };
  return {peak(0.85), peak(0.5), peak(0.15), 1};
}

/// Returns the pose of an OpenGL camera at `eye` looking at `target`, z of the world up.
Pose look_at(const Vec3& eye, const Vec3& target) {
  Vec3 back = eye - target;
  // Any direction will do.
  if (back.norm() < 1e-9) back = Vec3(1, 0, 0);
  back.normalize();
  Vec3 right = Vec3::UnitZ().cross(back);
  if (right.norm() < 1e-6) right = Vec3::UnitY();
  right.normalize();
  Pose X = Pose::Identity();
  X.linear().col(0) = right;
  X.linear().col(1) = back.cross(right);
  X.linear().col(2) = back;
  X.translation() = eye;
  return X;
}

}  // namespace

FrameBuilder::FrameBuilder(const World& world, const std::string& show)
    : world_(world), plates_(std::make_unique<ParticleClipper>(world)) {
  // Fill in constants once.
  for (const scene::Soil& soil : world.description().soils) {
    frame_.ground.soil_color.push_back({soil.color[0], soil.color[1], soil.color[2], 1.0f});
    frame_.ground.soil_moist.push_back(soil.moist ? 1 : 0);
  }
  for (const scene::Overlay one : scene::overlays_of(show)) {
    if (one == scene::Overlay::kCutFill) frame_.ground.cut_fill = kFullChange;
    if (one == scene::Overlay::kActive || one == scene::Overlay::kDensity ||
        one == scene::Overlay::kSpeed)
      color_ = one;
  }
  // Colored particles have the indices after those of the soils.
  if (color_)
    for (int i = 0; i < kShades; ++i) {
      frame_.ground.soil_color.push_back(shade((i + 0.5) / kShades));
      frame_.ground.soil_moist.push_back(0);
    }
  frame_.lights = world.description().lights;
  if (frame_.lights.empty()) frame_.lights.push_back({});
  frame_.ground.cell = world.ground().cell();
}

FrameBuilder::~FrameBuilder() = default;

// Rewrites everything that moves, and only the changed part of the ground.
const scene::Frame& FrameBuilder::build() {
  // Clear the vectors without freeing them: frames of one world have similar sizes.
  frame_.time = world_.time();
  frame_.shapes.clear();
  frame_.cylinders.clear();
  place_window();
  update_ground();
  add_machines();
  add_particles();
  return frame_;
}

void FrameBuilder::place_window() {
  const heightfield::Ground& ground = world_.ground();
  const int nx = std::min(ground.nx(), kWindow), ny = std::min(ground.ny(), kWindow);
  Vec2 low = ground.origin() + 0.5 * ground.cell() * Vec2(ground.nx(), ground.ny()), high = low;
  for (std::size_t m = 0; m < world_.description().machines.size(); ++m) {
    const Vec2 p = world_.machines().at(static_cast<int>(m)).link(0).pose().translation().head<2>();
    low = m == 0 ? p : Vec2(low.cwiseMin(p));
    high = m == 0 ? p : Vec2(high.cwiseMax(p));
  }
  const Vec2i center = ground.column_at(0.5 * (low.x() + high.x()), 0.5 * (low.y() + high.y()));
  // The window follows the middle of the machines, but moves only when they approach its edge,
  // since each move costs a whole copy.
  const bool placed = !window_.empty();
  const bool near_edge = std::abs(center.x() - (window_.x0 + window_.x1) / 2) > nx / 4 ||
                         std::abs(center.y() - (window_.y0 + window_.y1) / 2) > ny / 4;
  const bool whole = nx == ground.nx() && ny == ground.ny();
  // A window over the whole site never moves.
  if (placed && (whole || !near_edge)) return;
  const int x0 = std::clamp(center.x() - nx / 2, 0, ground.nx() - nx);
  const int y0 = std::clamp(center.y() - ny / 2, 0, ground.ny() - ny);
  if (placed && x0 == window_.x0 && y0 == window_.y0) return;
  window_ = {x0, y0, x0 + nx, y0 + ny};
  scene::FrameGround& out = frame_.ground;
  out.nx = nx;
  out.ny = ny;
  out.origin = ground.origin() + ground.cell() * Vec2(x0, y0);
  const std::size_t n = static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny);
  out.height.assign(n, 0);
  out.top.assign(n, 0);
  out.change.assign(n, 0);
  out.soil.assign(n, 0);
  changes_.forget();
  loose_changes_.forget();
  out.revision = 0;
}

// Cuts each changed rectangle to the window.
void FrameBuilder::update_ground() {
  const heightfield::TerrainView terrain = terrain_view(world_, kDrawn);
  scene::FrameGround& out = frame_.ground;
  // Skipped frames lose nothing: changes accumulate since the last frame built.
  out.changed.clear();
  for (const heightfield::CellRect& changed : changes_.take(terrain)) {
    const heightfield::CellRect rect = changed.cut(window_);
    if (rect.empty()) continue;
    copy_ground(terrain, rect);
    mark_changed(rect);
  }
  update_loose(terrain);
  if (!out.changed.empty()) ++out.revision;
}

// Soil in buckets and in the air is not part of it.
void FrameBuilder::update_loose(const heightfield::TerrainView& columns) {
  const heightfield::TerrainView loose =
      columns.with(active_places(world_).on_ground, heightfield::SurfaceKind::kMapped);
  scene::FrameGround& out = frame_.ground;
  for (const heightfield::CellRect& changed : loose_changes_.take(loose)) {
    const heightfield::CellRect rect = changed.cut(window_);
    if (rect.empty()) continue;
    for (int iy = rect.y0; iy < rect.y1; ++iy)
      for (int ix = rect.x0; ix < rect.x1; ++ix)
        out.top[static_cast<std::size_t>(iy - window_.y0) * static_cast<std::size_t>(out.nx) +
                static_cast<std::size_t>(ix - window_.x0)] =
            static_cast<float>(loose.height(ix, iy));
    mark_changed(rect);
  }
}

void FrameBuilder::mark_changed(const heightfield::CellRect& rect) {
  frame_.ground.changed.push_back(
      {rect.x0 - window_.x0, rect.y0 - window_.y0, rect.x1 - window_.x0, rect.y1 - window_.y0});
}

void FrameBuilder::copy_ground(const heightfield::Terrain& terrain,
                               const heightfield::CellRect& rect) {
  scene::FrameGround& out = frame_.ground;
  for (int iy = rect.y0; iy < rect.y1; ++iy)
    for (int ix = rect.x0; ix < rect.x1; ++ix) {
      const std::size_t i =
          static_cast<std::size_t>(iy - window_.y0) * static_cast<std::size_t>(out.nx) +
          static_cast<std::size_t>(ix - window_.x0);
      // Subtract in double: both heights may be hundreds of metres.
      const double height = terrain.height(ix, iy);
      out.height[i] = static_cast<float>(height);
      out.change[i] = static_cast<float>(height - terrain.start_height(ix, iy));
      out.soil[i] = static_cast<std::uint8_t>(terrain.surface_soil(ix, iy));
    }
}

// Visuals move with their links; cylinders follow from joint positions.
void FrameBuilder::add_machines() {
  for (std::size_t m = 0; m < world_.description().machines.size(); ++m) {
    const scene::Machine& machine = world_.description().machines[m].machine;
    const int index = static_cast<int>(m);
    for (std::size_t l = 0; l < machine.links.size(); ++l) {
      const Pose X_WL = world_.machines().at(index).link(static_cast<int>(l)).pose();
      for (const scene::Visual& visual : machine.links[l].visuals)
        frame_.shapes.push_back({&visual, X_WL * visual.X_LV});
    }
    add_cylinder_shapes(world_, index, frame_.cylinders);
  }
}

// Copies positions as floats relative to one block.
void FrameBuilder::add_particles() {
  const heightfield::Ground& ground = world_.ground();
  const std::vector<soil::Particle> particles = parts(world_).soil.particles();
  scene::FrameParticles& out = frame_.particles;
  out.position.clear();
  out.soil.clear();
  out.id.clear();
  out.clearance.clear();
  out.away.clear();
  out.radius = 0.4 * ground.cell();  // eight particles per cell, overlapping a little
  if (particles.empty()) return;
  // Positions are relative to the block of one particle: a float resolves 0.01 mm over a site of
  // 100 m.
  const auto& first = particles.front().block;
  const double block = soil::kBlockCells * ground.cell();
  out.origin = parts(world_).soil.grid_origin() + block * Vec3(first[0], first[1], first[2]);
  out.position.reserve(3 * particles.size());
  out.soil.reserve(particles.size());
  for (const soil::Particle& p : particles) {
    for (int i = 0; i < 3; ++i)
      out.position.push_back(
          static_cast<float>(block * (p.block[i] - first[i]) + ground.cell() * p.x[i]));
    const std::size_t soils = world_.description().soils.size();
    const int step = color_ ? std::min(static_cast<int>(shade_of(p) * kShades), kShades - 1) : 0;
    out.soil.push_back(
        static_cast<std::uint8_t>(color_ ? soils + static_cast<std::size_t>(step) : p.soil));
    out.id.push_back(p.id);
  }
  // Lumps vary in size randomly; twice the radius covers the largest. Particles on steel are moved
  // beside it rather than shrunk until they fit, or a load's outermost layer would look like a grid
  // of dust.
  plates_->keep_off(out, kOffPlates * out.radius, 2 * out.radius);
}

double FrameBuilder::shade_of(const soil::Particle& particle) const {
  double out = 0.8;  // orange, for all active soil
  if (color_ == scene::Overlay::kSpeed)
    out = Vec3(particle.v[0], particle.v[1], particle.v[2]).norm() / kFullSpeed;
  if (color_ == scene::Overlay::kDensity) {
    const double swell = world_.description().soils.at(particle.soil).swell;
    out = (particle.j - 1) / std::max(swell - 1, 1e-3);
  }
  // A particle out of hand must not be out of the scale.
  return out >= 0 ? std::min(out, 1.0) : 0.0;
}

// Fixed, on a link, or following a machine's heading.
scene::FrameCamera FrameBuilder::camera(const scene::Camera& camera) {
  scene::FrameCamera out;
  out.fov = camera.fov;
  out.width = camera.width;
  out.height = camera.height;
  out.samples = camera.samples;
  Pose X = Pose::Identity();
  // Fixed cameras are given in W, the others in the frame that they move with.
  if (camera.kind != scene::Camera::Kind::kFixed) {
    const int m = world_.description().machine_index(camera.machine);
    if (m < 0)
      throw InputError(Fault{Fault::Severity::kError, world_.description().file, 0,
                             "camera[" + camera.name + "]", camera.machine,
                             "there is no machine of this name", "name a machine of the scene"});
    const scene::Machine& machine =
        world_.description().machines[static_cast<std::size_t>(m)].machine;
    const int link = camera.kind == scene::Camera::Kind::kOnLink
                         ? std::max(0, machine.link_index(camera.link))
                         : 0;
    X = world_.machines().at(m).link(link).pose();
    if (camera.kind == scene::Camera::Kind::kChase) {
      const double yaw = std::atan2(X.linear()(1, 0), X.linear()(0, 0));
      X.linear() = Eigen::AngleAxisd(yaw, Vec3::UnitZ()).toRotationMatrix();
    }
  }
  out.X_WC = look_at(X * camera.position, X * camera.target);
  if (!framing_) framing_ = std::make_unique<const CameraFraming>(world_);
  frame_points(framing_->points(camera), out);
  // Keep the camera above the ground.
  const Vec3 eye = out.X_WC.translation();
  const double floor = terrain_view(world_, kDrawn).sample(eye.x(), eye.y()) + 0.3;
  if (eye.z() < floor && camera.kind != scene::Camera::Kind::kOnLink)
    out.X_WC.translation().z() = floor;
  return out;
}

}  // namespace navvy::sim
