// SPDX-License-Identifier: Apache-2.0
// A posed picture for tests and bench: the EW180 beside a trench, a heap of loose soil, a full
// bucket.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scene/frame.h"

namespace navvy::render {

/// Pose of the machine and angles of its arm [rad].
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

/// Makes ground of nx x ny columns of `cell` [m], slightly uneven, centred on the origin.
void make_ground(scene::FrameGround& ground, int nx, int ny, double cell);
/// Cuts a trench 4 m x 1.1 m x 0.9 m along x from (x0, y0) into `ground`, with a heap beside it.
void dig_trench(scene::FrameGround& ground, double x0, double y0);
/// Adds a box of soil particles, 8 per cell.
void add_soil(scene::FrameParticles& particles, const Vec3& low, const Vec3& high, double cell);
/// Adds the EW180's meshes of `mesh_dir` at `pose`, with its cylinders.
void add_machine(TrenchScene& scene, const std::string& mesh_dir, const MachinePose& pose);

/// Makes the complete scene; `nx` columns of 0.1 m per side.
void make_trench_scene(TrenchScene& scene, const std::string& mesh_dir, int nx);

}  // namespace navvy::render
