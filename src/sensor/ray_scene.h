// SPDX-License-Identifier: Apache-2.0
// The world as beams of light or sound meet it: ground, loose soil, machines and bodies.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/math.h"
#include "sensor/shape_mesh.h"
#include "sim/world.h"

namespace navvy::sensor {

/// Types of things that a beam meets.
enum class Met : std::uint8_t {
  kGround,  ///< surface of the columns and of the loose soil that rests on them
  kSoil,    ///< soil in the air, or in a bucket or bed
  kBody     ///< link of a machine, or body without joints
};

/// The first thing that a beam meets.
struct BeamHit {
  double distance = 0;    ///< distance from the origin of the beam [m]
  Met what = Met::kBody;  ///< type of the thing
  int machine = -1;       ///< index of the machine in the scene; -1 for soil
  int link = -1;          ///< index of the link in its machine; -1 for soil
};

/// All that beams can meet in one world, prepared for many queries at one instant.
///
/// Machines and bodies are their visuals, where a link has none its collisions and shells; meshes
/// and shapes become triangles in a tree per link, round shapes within 0.2 mm. Hydraulic cylinders
/// are round bars between their pins. The ground is bilinear between the middles of its columns,
/// as everywhere; its tiles know their highest points, so that a beam skips those that it passes
/// above. Soil in the air and in tools consists of balls of the particles' volumes, in a uniform
/// grid.
///
/// `update` costs a pass over the particles, a query about a microsecond. Not thread-safe.
class RayScene {
 public:
  /// Prepares the bodies of `world`, which must outlive this object.
  /// @throws FileError or InputError for a mesh that cannot be read.
  explicit RayScene(const sim::World& world);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  /// Brings the scene to the present state of the world, unless it has been brought there in this
  /// step already.
  void update();
  /// Makes the next `update` renew everything, after another state was loaded into the world.
  void forget();

  /// Returns the first thing within `reach` [m] that a beam from `p_W` along the unit vector
  /// `direction_W` meets; nothing if there is none, or if a coordinate is not finite.
  std::optional<BeamHit> first_hit(const Vec3& p_W, const Vec3& direction_W, double reach) const;
  /// Returns true if a point is within `margin` [m] of the box around a link of a machine, in the
  /// axes of the link, or of one of its hydraulic cylinders.
  bool on_machine(int machine, const Vec3& p_W, double margin) const;
  /// Returns what a point is inside of: the ground or a closed body.
  Enclosure around(const Vec3& p_W) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace navvy::sensor
