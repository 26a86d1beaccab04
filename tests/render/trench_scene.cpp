// SPDX-License-Identifier: Apache-2.0
#include "trench_scene.h"

#include <cmath>

#include "render/shading.h"

namespace navvy::render {
namespace {

std::size_t at(const scene::FrameGround& g, int ix, int iy) {
  return static_cast<std::size_t>(iy) * static_cast<std::size_t>(g.nx) +
         static_cast<std::size_t>(ix);
}

/// Fills the bucket with loose soil, given by inside corner points in its link frame.
void fill_bucket(scene::FrameParticles& particles, const Pose& X_WBucket, double cell) {
  const double step = 0.5 * cell;
  std::uint32_t n = 1000000;
  for (double x = 0.15; x < 1.15; x += step)
    for (double y = -0.44; y < 0.45; y += step)
      for (double z = -0.35; z < 0.42; z += step) {
        const double r =
            std::hypot((x - 0.66) / 0.60, (z - 0.03) / (z > 0.03 ? 0.44 : 0.24), y / 0.62);
        if (r > 1) continue;
        Vec3 p(x, y, z);
        for (int k = 0; k < 3; ++k) p[k] += step * 0.7 * (hash_unit(++n, 3) - 0.5);
        p = X_WBucket * p;
        for (int k = 0; k < 3; ++k)
          particles.position.push_back(static_cast<float>(p[k] - particles.origin[k]));
        particles.soil.push_back(0);
        particles.id.push_back(n);
      }
}

struct MachineFrames {
  Pose X_WM, upper, boom, stick, bucket;
};

MachineFrames forward_kinematics(const MachinePose& pose) {
  MachineFrames f;
  f.X_WM = make_pose(pose.x, pose.y, 0, 0, 0, pose.yaw);
  f.upper = f.X_WM * make_pose(1.25, 0, 1.18, 0, 0, pose.swing);
  f.boom = f.upper * make_pose(0.25, 0, 0.80, 0, -pose.boom, 0);
  f.stick = f.boom * make_pose(5.10, 0, 0, 0, -pose.stick, 0);
  f.bucket = f.stick * make_pose(2.45, 0, 0, 0, -pose.bucket, 0);
  return f;
}

void add_mesh(TrenchScene& scene, const std::string& file, const Pose& X_WV) {
  auto visual = std::make_unique<scene::Visual>();
  visual->name = file;
  visual->geometry.kind = scene::Geometry::Kind::kMesh;
  visual->geometry.mesh_file = file;
  scene.frame.shapes.push_back({visual.get(), X_WV});
  scene.visuals.push_back(std::move(visual));
}

void add_cylinder(TrenchScene& scene, const Vec3& base, const Vec3& rod, double radius,
                  double barrel) {
  scene.frame.cylinders.push_back({base, rod, radius, barrel * (rod - base).norm()});
}

}  // namespace

scene::FrameCamera look_from(const Vec3& eye, const Vec3& target, int width, int height,
                             double fov_degrees) {
  scene::FrameCamera out;
  const Vec3 back = (eye - target).normalized();
  Vec3 right = Vec3::UnitZ().cross(back);
  right = right.norm() < 1e-9 ? Vec3(1, 0, 0) : Vec3(right.normalized());
  out.X_WC.linear() << right, back.cross(right), back;
  out.X_WC.translation() = eye;
  out.fov = radians(fov_degrees);
  out.width = width;
  out.height = height;
  return out;
}

void make_ground(scene::FrameGround& ground, int nx, int ny, double cell) {
  ground.nx = nx;
  ground.ny = ny;
  ground.cell = cell;
  ground.origin = -0.5 * cell * Vec2(nx, ny);
  const std::size_t n = static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny);
  ground.height.resize(n);
  ground.change.assign(n, 0);
  ground.soil.assign(n, 0);
  ground.soil_color = {{0.46f, 0.34f, 0.22f, 1}};
  ground.revision = 1;
  for (int iy = 0; iy < ny; ++iy)
    for (int ix = 0; ix < nx; ++ix) {
      const double x = ground.origin.x() + (ix + 0.5) * cell,
                   y = ground.origin.y() + (iy + 0.5) * cell;
      const double far = smooth_step(9, 30, static_cast<float>(std::hypot(x, y)));
      ground.height[at(ground, ix, iy)] = static_cast<float>(
          far * (1.6 * std::sin(0.09 * x + 1) * std::cos(0.07 * y)) +
          0.02 * static_cast<double>(
                     value_noise(static_cast<float>(x) / 1.7f, static_cast<float>(y) / 1.7f, 5)));
    }
}

void dig_trench(scene::FrameGround& ground, double x0, double y0) {
  for (int iy = 0; iy < ground.ny; ++iy)
    for (int ix = 0; ix < ground.nx; ++ix) {
      const double x = ground.origin.x() + (ix + 0.5) * ground.cell,
                   y = ground.origin.y() + (iy + 0.5) * ground.cell;
      double change = 0;
      const double rough =
          hash_unit(static_cast<std::uint32_t>(ix), static_cast<std::uint32_t>(iy), 6) - 0.5;
      if (x > x0 && x < x0 + 4 && std::abs(y - y0) < 0.55)
        change = -std::min(0.9, 1.4 * std::min(x - x0 + 0.1, 10.0)) + 0.05 * rough;
      const double along = std::max(0.0, std::abs(x - x0 - 2.2) - 0.9);
      const double heap = 1.05 - 0.66 * std::hypot(along, y - y0 - 2.9);
      if (heap > 0) change = heap + 0.05 * rough;
      ground.height[at(ground, ix, iy)] += static_cast<float>(change);
      ground.change[at(ground, ix, iy)] += static_cast<float>(change);
    }
  ground.changed = {{0, 0, ground.nx, ground.ny}};
  ++ground.revision;
}

void add_soil(scene::FrameParticles& particles, const Vec3& low, const Vec3& high, double cell) {
  const double step = 0.5 * cell;
  particles.radius = 0.4 * cell;
  auto n = static_cast<std::uint32_t>(particles.position.size());
  for (double x = low.x(); x < high.x(); x += step)
    for (double y = low.y(); y < high.y(); y += step)
      for (double z = low.z(); z < high.z(); z += step) {
        const Vec3 p(x, y, z);
        ++n;
        for (int k = 0; k < 3; ++k)
          particles.position.push_back(
              static_cast<float>(p[k] - particles.origin[k] +
                                 0.7 * step * (hash_unit(n, static_cast<std::uint32_t>(k)) - 0.5)));
        particles.soil.push_back(0);
        particles.id.push_back(n);
      }
}

void add_machine(TrenchScene& scene, const std::string& dir, const MachinePose& pose) {
  const MachineFrames f = forward_kinematics(pose);
  add_mesh(scene, dir + "/chassis.obj", f.X_WM);
  add_mesh(scene, dir + "/front_axle.obj", f.X_WM * make_pose(2.8, 0, 0.525));
  for (const double side : {1.0, -1.0}) {
    const Pose knuckle = f.X_WM * make_pose(2.8, side * 0.97, 0.525, 0, 0, pose.steer);
    add_mesh(scene, dir + "/knuckle.obj", knuckle);
    add_mesh(scene, dir + "/wheel_pair.obj", knuckle);
    add_mesh(scene, dir + "/wheel_pair.obj", f.X_WM * make_pose(0, side * 0.97, 0.525));
  }
  add_mesh(scene, dir + "/upper.obj", f.upper);
  add_mesh(scene, dir + "/boom.obj", f.boom);
  add_mesh(scene, dir + "/stick.obj", f.stick);
  add_mesh(scene, dir + "/bucket.obj", f.bucket);
  // Pins in the picture, close to those of the machine's model.
  for (const double side : {0.34, -0.34})
    add_cylinder(scene, f.upper * Vec3(0.70, side, 0.20), f.boom * Vec3(2.20, side, 0.55), 0.075,
                 0.6);
  add_cylinder(scene, f.boom * Vec3(2.90, 0, 0.90), f.stick * Vec3(-0.68, 0, 0.17), 0.08, 0.6);
  // Bucket linkage: intersection of the rocker's circle about its pivot with the coupler's about
  // the pin on the bucket.
  const Vec3 pivot(2.084, 0, 0), pin = f.stick.inverse() * (f.bucket * Vec3(-0.2907, 0, 0.3294));
  const double reach = 0.697, coupler = 0.62, d = (pin - pivot).norm();
  const double along = (reach * reach - coupler * coupler + d * d) / (2 * d);
  const Vec3 direction = (pin - pivot) / d;
  const Vec3 joint = pivot + along * direction +
                     std::sqrt(std::max(0.0, reach * reach - along * along)) *
                         Vec3(-direction.z(), 0, direction.x());
  add_cylinder(scene, f.stick * Vec3(-0.097, 0, 0.314), f.stick * joint, 0.065, 0.6);
  for (const double side : {0.20, -0.20}) {
    const Vec3 y(0, side, 0);
    add_cylinder(scene, f.stick * (pivot + y), f.stick * (joint + y), 0.05, 1);
    add_cylinder(scene, f.stick * (joint + y), f.stick * (pin + y), 0.05, 1);
  }
}

void make_trench_scene(TrenchScene& scene, const std::string& mesh_dir, int nx) {
  make_ground(scene.frame.ground, nx, nx, 0.1);
  dig_trench(scene.frame.ground, 3.2, 0);
  MachinePose pose;
  pose.x = -3.2;
  pose.boom = 0.62;
  pose.stick = -1.75;
  pose.bucket = -1.45;
  pose.steer = 0.25;
  pose.swing = 0.42;
  add_machine(scene, mesh_dir, pose);
  scene::FrameParticles& particles = scene.frame.particles;
  fill_bucket(particles, forward_kinematics(pose).bucket, 0.1);
  add_soil(particles, Vec3(5.2, -0.4, -0.95), Vec3(6.2, 0.4, -0.55), 0.1);
  // A few particles fall from the bucket.
  const Vec3 mouth = forward_kinematics(pose).bucket * Vec3(1.2, 0, -0.2);
  std::uint32_t n = 5000000;
  for (int i = 0; i < 260; ++i) {
    const double t = hash_unit(++n, 1);
    const Vec3 p(mouth.x() + 0.5 * (hash_unit(n, 2) - 0.5),
                 mouth.y() + 0.8 * (hash_unit(n, 3) - 0.5), mouth.z() - 2.0 * t * t);
    for (int k = 0; k < 3; ++k) particles.position.push_back(static_cast<float>(p[k]));
    particles.soil.push_back(0);
    particles.id.push_back(n);
  }
}

}  // namespace navvy::render
