// SPDX-License-Identifier: Apache-2.0
// A posed picture for tests and bench: the EW180 beside a trench, a heap of loose soil, a full
// bucket.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scene/frame.h"

namespace navvy::render {

/// Angles of the arm and the rest of the machine [rad]; where it stands.
struct MachinePose {
  double x = 0, y = 0, yaw = 0;
  double swing = 0, boom = 0.35, stick = -1.5, bucket = -1.4, steer = 0;
};

/// Owns the visuals that its frame points to.
struct TrenchScene {
  scene::Frame frame;
  std::vector<std::unique_ptr<scene::Visual>> visuals;
};

/// Camera at `eye` looking at `target`, z up.
scene::FrameCamera look_from(const Vec3& eye, const Vec3& target, int width = 1280,
                             int height = 720, double fov_degrees = 50);

/// Ground of nx x ny columns of `cell` [m], gently uneven, centred on the origin.
void make_ground(scene::FrameGround& ground, int nx, int ny, double cell);
/// Trench 4 m x 1.1 m x 0.9 m along x from (x0, y0) and a heap beside it, cut into `ground`.
void dig_trench(scene::FrameGround& ground, double x0, double y0);
/// Box of soil particles, 8 a cell.
void add_soil(scene::FrameParticles& particles, const Vec3& low, const Vec3& high, double cell);
/// The EW180's meshes of `mesh_dir` at `pose`, with its cylinders.
void add_machine(TrenchScene& scene, const std::string& mesh_dir, const MachinePose& pose);

/// Everything together; `nx` columns of 0.1 m a side.
void make_trench_scene(TrenchScene& scene, const std::string& mesh_dir, int nx);

}  // namespace navvy::render
