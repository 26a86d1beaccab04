// SPDX-License-Identifier: Apache-2.0
// A whole scene: soils, ground, machines with their programs, cameras and what to record.
#pragma once

#include <string>
#include <vector>

#include "core/math.h"
#include "scene/ground.h"
#include "scene/machine.h"
#include "scene/program.h"
#include "scene/soil.h"

namespace navvy::scene {

struct Solver {
  double cell = 0.1;            ///< edge of a soil cell and of a column [m]
  double courant = 0.5;         ///< share of cell / sound speed
  double max_step = 0.0017;     ///< base step never exceeds this [s]
  int max_particles = 2000000;  ///< the awake budget
  bool exchange = true;         ///< false: ground neither wakes nor takes soil back by itself (rigs, tests)
};

/// Soil in a machine's first bed at the start.
struct BedLoad {
  std::string soil;
  double mass = 0;  ///< [kg]; 0: empty
};

struct MachineInWorld {
  std::string name;
  Machine machine;
  Pose X_WM = Pose::Identity();
  bool on_ground = true;  ///< z of the pose counts from the ground under the machine
  BedLoad load;
  Program program;
};

struct Camera {
  enum class Kind { kFixed, kChase, kOnLink };
  std::string name;
  Kind kind = Kind::kFixed;
  std::string machine, link;       ///< chase: machine; on_link: both
  Vec3 position = Vec3(8, -8, 5);  ///< W (fixed), M (chase), L (on link) [m]
  Vec3 target = Vec3::Zero();      ///< same frame [m]
  double fov = radians(50);        ///< horizontal [rad]
  int width = 1280, height = 720;
  double rate = 4;  ///< frames per simulated second
};

struct Light {
  Vec3 direction = Vec3(-0.5, 0.35, -0.8);  ///< the way the light travels
  Color color{1.0f, 0.97f, 0.9f, 1.0f};
};

struct Recording {
  double duration = 60;        ///< most simulated time [s]; the run ends earlier when every program has ended
  double settle = 1.0;         ///< after the last program ended; six times as long while soil is awake [s]
  double telemetry_rate = 50;  ///< [1/s]
  bool render = true;
};

struct World {
  std::string name;
  std::string file;
  Vec3 gravity = Vec3(0, 0, -kGravity);
  std::uint64_t seed = 1;
  Solver solver;
  std::vector<Soil> soils;
  Ground ground;
  std::vector<MachineInWorld> machines;
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  Recording recording;

  /// Index by name, -1 when there is none.
  int soil_index(const std::string& name_of_soil) const;
  int machine_index(const std::string& name_of_machine) const;
};

}  // namespace navvy::scene
