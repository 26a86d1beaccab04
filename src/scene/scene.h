// SPDX-License-Identifier: Apache-2.0
// A whole scene: soils, ground, machines with their programs, cameras and what to record.
#pragma once

#include <string>
#include <vector>

#include "core/limits.h"
#include "core/math.h"
#include "scene/design.h"
#include "scene/fields.h"
#include "scene/ground.h"
#include "scene/hitch.h"
#include "scene/machine.h"
#include "scene/material.h"
#include "scene/program.h"
#include "scene/soil.h"

namespace navvy::scene {

/// Settings of the soil solver. They are not properties of the soil.
struct SolverSettings {
  double cell = 0.1;
  double courant = 0.5;
  double max_step = 0.0017;
  /// Rate of an external controller [1/s]; 0 if none is requested.
  double control_rate = 0;
  int max_particles = 2000000;
  double active_zone = 1;
  /// If false, the ground neither activates soil nor takes soil back (for rigs and tests).
  bool exchange = true;

  void describe(Fields& f) {
    f("cell_m", cell, {0.005, 2}, "Edge of a soil cell and of a ground column.");
    f("courant", courant, {0.05, 1}, "Time step / longest stable time step.");
    f("max_step_s", max_step, {1e-6, 0.02}, "Longest base step.");
    // It acts through the base step alone, which the state holds: a controller may resume the
    // snapshot of a run without one.
    f("control_rate_hz", control_rate, {0.001, 1e5},
      "Rate whose period is a whole number of base steps.", kShown);
    f("max_particles", max_particles, {1000, limits::kParticles},
      "Budget of particles. Beyond it, the ground farthest from the tools is not activated.");
    f("active_zone", active_zone, {0.5, 4},
      "Factor of the zone around and below a tool in which soil is active.");
    f.derived("exchange", exchange);
  }
};

/// Loose soil in a machine's bed at the start.
struct BedLoad {
  std::string soil;
  /// Mass of the soil [kg]; 0 for an empty bed.
  double mass = 0;

  void describe(Fields& f) {
    f("soil", soil, Refers::kSoil, "Soil of the load; by default the first one.");
    f("mass_kg", mass, {0, 1e6}, "Mass of the load.", kNeeded);
  }
};

/// A machine in a scene, with its pose, load and program. X_WM takes the machine frame M to the
/// world W.
struct MachineInWorld {
  std::string name;
  Machine machine;
  Pose X_WM = Pose::Identity();
  bool on_ground = true;
  BedLoad load;
  Program program;
  /// Line of the machine's element in the scene file, for messages.
  int line = 0;
  /// True for a <model> in the scene file, false for an <include>.
  bool in_scene = false;
  /// Initial joint positions given by an <include>.
  std::vector<InitialPosition> initial_positions;

  void describe(Fields& f) {
    if (in_scene) {
      f.attribute("name", name, "Name of the machine.", kSdf);
      machine.describe(f);
    }
    describe_instance(f);
  }
  /// Visits the fields of an <include>, and those fields of a <model> that are allowed in scene
  /// files but not in machine files.
  void describe_instance(Fields& f) {
    if (!in_scene) {
      f("uri", machine.file, "SDF file, its directory, or model://NAME of a shipped machine.",
        kSdf | kShown | kNeeded);
      f("name", name, "Name of the machine; by default that of its model.", kSdf | kShown);
      f("navvy:physics", machine.kinematic, {{"dynamic", false}, {"kinematic", true}},
        "kinematic: commands alone move a machine whose file is dynamic.", kShown);
      f("navvy:joint", initial_positions, limits::kLinks, "Position of a joint at the start.",
        kShown);
      f.elsewhere([this](Fields& g) {
        g.attribute("name", name, "");
        machine.describe(g);
      });
    }
    f("pose", X_WM, "Place x y z [m] and turn roll pitch yaw [rad] in W.", kSdf);
    f("navvy:on_ground", on_ground,
      "z of the pose counts from the ground, and a machine on three wheels or more is tilted with "
      "the plane under them.");
    f.group({"navvy:load", "Loose soil in the machine's bed at the start.", {}, load.mass > 0, {}},
            [this](Fields& g) { load.describe(g); });
    f("navvy:program", program, "Steps of the machine, in order.", kOwnReader);
  }
};

/// A camera that records pictures at a constant rate. Its type determines the frame of `position`
/// and `target`: W for a fixed camera, the machine frame for a chase camera, the link frame for a
/// camera on a link.
struct Camera {
  enum class Kind { kFixed, kChase, kOnLink };
  std::string name;
  Kind kind = Kind::kFixed;
  /// Name of the machine (chase camera and camera on a link) and of the link (camera on a link);
  /// otherwise empty.
  std::string machine, link;
  /// Position of the camera [m].
  Vec3 position = Vec3(8, -8, 5);
  /// Point in the middle of the picture [m].
  Vec3 target = Vec3::Zero();
  double fov = radians(50);
  int width = 1280, height = 720;
  double rate = 4;

  void describe(Fields& f) {
    f.attribute("name", name, "Name of the image files.", kNeeded);
    f("machine", machine, "Machine that the camera follows; without it the camera is fixed in W.");
    f("link", link, "Link of the machine that carries the camera.");
    f("position_m", position, kPlaceRange, "Place in W, or in the frame of machine or link.");
    f("target_m", target, kPlaceRange, "Point in the middle of the image, in the same frame.");
    f("fov_deg", fov, {1, 170}, "Horizontal field of view.");
    f("width_px", width, {16, 8192}, "Width of an image.");
    f("height_px", height, {16, 8192}, "Height of an image.");
    f("rate_hz", rate, {0.001, 1000}, "Images per simulated second.");
  }
};

/// A directional light. The first light of a scene is the sun, which casts shadows.
struct Light {
  /// Direction in which the light travels.
  Vec3 direction = Vec3(-0.5, 0.35, -0.8);
  Color color{1.0f, 0.97f, 0.9f, 1.0f};

  void describe(Fields&) {}
};

/// Length of a run and rates of its output, in simulated time.
struct Recording {
  double duration = 60;
  double settle = 1.0;
  double telemetry_rate = 50;
  bool render = true;

  void describe(Fields& f) {
    f("duration_s", duration, {1e-3, 1e6},
      "Longest simulated time; the run ends earlier when every program has ended.");
    f("settle_s", settle, {0, 1e5},
      "Time after the last program ended; up to six times as long while soil is active.");
    f("telemetry_rate_hz", telemetry_rate, {0.01, 1e5}, "Rows of telemetry per simulated second.");
    f("render", render, "Cameras draw images.");
  }
};

/// Maps or ROS 2 messages that a run writes at a constant rate. They do not influence the
/// simulation.
struct MapRecord {
  /// Default of `machine_rate` [1/s].
  static constexpr double kMachineRate = 50;

  /// Line of the <navvy:record> in the scene file, for messages.
  int line = 0;
  /// Name of the files in the run's folder.
  std::string name;
  /// Name of a map format, "mcap" or "bag".
  std::string format;
  /// Names of the layers to write; empty for the format's usual layers.
  std::vector<std::string> layers;
  double rate = 1;
  /// Rate of machine poses, joint positions and clock messages [1/s]; 0 stands for kMachineRate.
  double machine_rate = 0;
  /// `layers` as one text, as the file gives them.
  std::string layer_names;

  void describe(Fields& f) {
    f.attribute("name", name, "Name of the files.", kNeeded);
    f("format", format, "A format of `navvy map`, or mcap or bag for ROS 2.", kNeeded);
    f("layers", layer_names, "Layers, separated by blanks; by default those of the format.");
    f("rate_hz", rate, {0.001, 1000}, "Maps per simulated second.");
    f("machine_rate_hz", machine_rate, {0.001, 1000},
      "Rate of poses, joints and clock in mcap and bag; by default 50.");
  }
};

/// A complete scene as data, in SI units: everything that a run starts from. On one device, equal
/// scenes give equal runs.
struct Scene {
  std::string name;
  /// Path of the scene file.
  std::string file;
  /// Acceleration of gravity in W [m/s2].
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

  void describe(Fields& f) {
    f.attribute("name", name, "Name of the scene and of the folder of its results.", kSdf | kShown);
    f("gravity", gravity, {-100, 100}, "Acceleration of gravity in W [m/s2].", kSdf);
    f("navvy:seed", seed, "Seed of everything random: hills and faults of encoders.");
    f("navvy:soil", soils, limits::kSoils, "Soil, by values of its own or by a shipped one.",
      kNeeded);
    f("navvy:ground", ground, "Ground of the site.", kNeeded);
    f("navvy:design", design, "Design surface: either a file or areas. It steers nothing.", kShown);
    f("navvy:solver", solver, "Settings of the soil solver.");
    f("navvy:materials", materials, "Contact properties of rigid bodies, by pairs of materials.");
    MachineInWorld model;
    model.in_scene = true;
    f.list("machine", machines, limits::kMachines,
           std::vector<Start<MachineInWorld>>{
               {"include", "Machine of a file of its own.", MachineInWorld()},
               {"model", "Machine that stands in the scene file.", model}},
           kSdf);
    f("navvy:hitch", hitches, limits::kMachines, "Ball joint between two machines that can open.");
    f("navvy:camera", cameras, limits::kMachines, "Camera that records images.", kShown);
    f("light", lights, limits::kMachines, "Directional light.", kSdf | kShown);
    f("navvy:recording", recording, "Length and output of a run.", kShown);
    f("navvy:record", records, limits::kMachines, "Maps that a run writes at a rate.", kShown);
  }

  /// Returns the index of the soil or machine with this name; -1 if there is none. The search is
  /// linear.
  int soil_index(const std::string& name_of_soil) const;
  int machine_index(const std::string& name_of_machine) const;
};

}  // namespace navvy::scene
