// SPDX-License-Identifier: Apache-2.0
// A whole scene: soils, ground, machines with their programs, cameras and what to record.
#pragma once

#include <string>
#include <vector>

#include "core/math.h"
#include "scene/design.h"
#include "scene/ground.h"
#include "scene/hitch.h"
#include "scene/machine.h"
#include "scene/material.h"
#include "scene/program.h"
#include "scene/soil.h"

namespace navvy::scene {

/// How the soil is computed. None of it is a property of the soil.
struct SolverSettings {
  double cell = 0.1;         ///< edge of a soil cell and of a column [m]
  double courant = 0.5;      ///< share of cell / sound speed
  double max_step = 0.0017;  ///< base step never exceeds this [s]
  /// A whole number of base steps makes up its period [1/s]; 0: no such rate.
  double control_rate = 0;
  int max_particles = 2000000;  ///< the awake budget
  double active_zone = 1;       ///< multiplies how far around and below itself a tool wakes soil
  /// false: ground neither wakes nor takes soil back by itself (rigs, tests).
  bool exchange = true;
};

/// Soil in a machine's first bed at the start.
struct BedLoad {
  std::string soil;
  double mass = 0;  ///< [kg]; 0: empty
};

/// A machine and what is said of it here: its place, its load and what it does. W is the world, M
/// the machine's own frame.
struct MachineInWorld {
  std::string name;
  Machine machine;
  Pose X_WM = Pose::Identity();
  bool on_ground = true;  ///< z of the pose counts from the ground under the machine
  BedLoad load;
  Program program;
  int line = 0;  ///< of the scene's file, for messages
};

/// A camera that records pictures at a rate. The frame in which its two points are given follows
/// from the kind.
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

/// A light from far away: it has a direction and no place. The first one is the sun and throws
/// shadows.
struct Light {
  Vec3 direction = Vec3(-0.5, 0.35, -0.8);  ///< the way the light travels
  Color color{1.0f, 0.97f, 0.9f, 1.0f};
};

/// What a run writes and how long it lasts, all in simulated time.
struct Recording {
  /// Most simulated time [s]; the run ends earlier when every program has ended.
  double duration = 60;
  /// After the last program ended; six times as long while soil is awake [s].
  double settle = 1.0;
  double telemetry_rate = 50;  ///< [1/s]
  bool render = true;
};

/// Maps or messages written while a scene runs, at a rate. They decide nothing of what the run
/// comes to.
struct MapRecord {
  static constexpr double kMachineRate = 50;  ///< of a bag that names none [1/s]

  int line = 0;                     ///< of the scene's file, for messages
  std::string name;                 ///< of the files in the run's folder
  std::string format;               ///< as the planner's formats are called, or "mcap", "bag"
  std::vector<std::string> layers;  ///< by name; empty: what the format is made for
  double rate = 1;                  ///< of maps [1/s]
  /// Of a bag's poses, joints and clock [1/s]; 0: not named, so kMachineRate.
  double machine_rate = 0;
};

/// A scene as data: everything that a run starts from, resolved and in SI units. Two equal worlds
/// give equal runs on one device.
struct Scene {
  std::string name;
  // Path of the file it came from; relative names in the scene were resolved against it.
  std::string file;
  // In W [m/s2]; soil and machines both take it from here.
  Vec3 gravity = Vec3(0, 0, -kGravity);
  std::uint64_t seed = 1;
  SolverSettings solver;
  std::vector<Soil> soils;
  StartGround ground;
  Design design;
  Materials materials;
  std::vector<MachineInWorld> machines;
  std::vector<Hitch> hitches;
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  Recording recording;
  std::vector<MapRecord> records;

  /// Index by name, -1 when there is none. The search is linear: names are resolved once.
  int soil_index(const std::string& name_of_soil) const;
  int machine_index(const std::string& name_of_machine) const;
};

}  // namespace navvy::scene
