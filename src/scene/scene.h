// SPDX-License-Identifier: Apache-2.0
// A whole scene: soils, ground, machines with their programs, cameras, and the output of a run.
#pragma once

#include <string>
#include <vector>

#include "core/limits.h"
#include "core/math.h"
#include "scene/design.h"
#include "scene/fields.h"
#include "scene/forbidden.h"
#include "scene/goals.h"
#include "scene/ground.h"
#include "scene/hitch.h"
#include "scene/machine.h"
#include "scene/material.h"
#include "scene/program.h"
#include "scene/soil.h"

namespace navvy::scene {

/// Settings of the soil solver. None of them is a property of a soil.
struct SolverSettings {
  double cell = 0.1;         ///< edge of a soil cell and of a ground column [m]
  double courant = 2.0 / 3;  ///< time step / longest stable time step [-]
  double max_step = 0.0025;  ///< longest base step, whatever the soil allows [s]
  /// Rate of a controller [1/s]; the base step is chosen so that the period of this rate is a whole
  /// number of base steps. 0: no controller.
  double control_rate = 0;
  int max_particles = 2000000;  ///< maximum number of particles
  /// Factor on the size of the zone around a tool in which soil is active [-].
  double active_zone = 1;
  /// False: the ground neither activates nor deposits soil, as in rigs and tests.
  bool exchange = true;

  /// Passes the fields of <navvy:solver> to the visitor `f`.
  void describe(Fields& f) {
    f("cell_m", cell, {0.005, 2}, "Edge of a soil cell and of a ground column.");
    f("courant", courant, {0.05, 1}, "Time step / longest stable time step.");
    f("max_step_s", max_step, {1e-6, 0.02}, "Longest base step, whatever the soil allows.");
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

/// Loose soil that lies in a machine's first bed at the start.
struct BedLoad {
  std::string soil;  ///< name of the soil; empty: the first soil of the scene
  double mass = 0;   ///< mass of the soil [kg]; 0: the bed is empty

  /// Passes the fields of <navvy:load> to the visitor `f`.
  void describe(Fields& f) {
    f("soil", soil, Refers::kSoil, "Soil of the load; by default the first one.");
    f("mass_kg", mass, {0, 1e6}, "Mass of the load.", kNeeded);
  }
};

/// A machine with its pose in a scene, its load and its program. W is the frame of the world, M
/// that of the machine.
struct MachineInWorld {
  std::string name;              ///< unique name of the machine in the scene
  Machine machine;               ///< description of the machine
  Pose X_WM = Pose::Identity();  ///< pose of the machine at the start, as in the file
  /// True: z of the pose is relative to the ground surface, and a machine with three or more wheels
  /// is tilted to stand on the plane below them.
  bool on_ground = true;
  BedLoad load;     ///< soil in the machine's bed at the start
  Program program;  ///< steps that the machine executes
  int line = 0;     ///< line of the machine in the scene file, for messages
  /// True: a <model> in the scene file describes the machine. False: the scene names another file
  /// in an <include>.
  bool in_scene = false;
  std::vector<InitialPosition> initial_positions;  ///< joint positions that an <include> sets
  /// Bucket that an <include> fits in place of the machine's own; the reader has done so.
  std::optional<Bucket> bucket;
  /// Sensors as the scene gives them; the reader has moved them to the links that carry them.
  std::vector<Sensor> sensors;

  /// Passes all fields of an <include> or <model> to the visitor `f`.
  void describe(Fields& f) {
    if (in_scene) {
      f.attribute("name", name, "Name of the machine.", kSdf);
      machine.describe(f);
    }
    describe_instance(f);
  }
  /// Passes fields to the visitor `f`: without `in_scene` the fields of an <include>, with
  /// `in_scene` the fields that a <model> written directly in a scene has in addition to those of a
  /// machine's own file.
  void describe_instance(Fields& f) {
    if (!in_scene) {
      f("uri", machine.file, "SDF file, its directory, or model://NAME of a shipped machine.",
        kSdf | kShown | kNeeded);
      f("name", name, "Name of the machine; by default that of its model.", kSdf | kShown);
      f("navvy:physics", machine.kinematic, {{"dynamic", false}, {"kinematic", true}},
        "kinematic: commands alone move a machine whose file is dynamic.", kShown);
      f("navvy:joint", initial_positions, limits::kLinks, "Position of a joint at the start.",
        kShown);
      f("navvy:bucket", bucket, "Bucket in place of the machine's own; it has no <shell>.", kShown);
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
    f("navvy:sensor", sensors, kMostSensors,
      "Sensor that the scene adds to a link of the machine; its elements are those of <sensor>.",
      kShown);
  }
};

/// A camera that records images at a fixed rate. Its type determines the frame of its position and
/// target: W if it is fixed, M if it follows a machine, L if a link carries it.
struct Camera {
  /// Type of mounting: fixed in the world, following a machine, or mounted on a link.
  enum class Kind { kFixed, kChase, kOnLink };
  /// Subject of the pictures: the camera moves along its direction until the subject fills them.
  enum class Framed { kNothing, kMachine, kProgram, kAll };
  std::string name;          ///< name of the camera and of its image files
  Kind kind = Kind::kFixed;  ///< type of mounting
  /// Names of the machine (kChase and kOnLink) and of the link (kOnLink).
  std::string machine, link;
  Vec3 position = Vec3(8, -8, 5);  ///< position of the camera in its frame [m]
  Vec3 target = Vec3::Zero();      ///< point in the middle of the image, in the same frame [m]
  double fov = radians(50);        ///< horizontal field of view [rad]
  int width = 1280, height = 720;  ///< width and height of an image [pixels]
  double rate = 4;                 ///< images per second of simulated time
  /// Subject of the pictures; `position` and `target` then give only the direction.
  Framed frame = Framed::kNothing;
  int samples = 4;  ///< samples per pixel, 1 or 4

  /// Passes the fields of <navvy:camera> to the visitor `f`.
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
    f("frame", frame,
      {{"none", Framed::kNothing},
       {"machine", Framed::kMachine},
       {"program", Framed::kProgram},
       {"all", Framed::kAll}},
      "What fills the pictures: the camera keeps its direction and moves closer or away.");
    f("samples", samples, {{"1", 1}, {"4", 4}}, "Samples per pixel; 4 smooth the edges.");
  }
};

/// A directional light. The first light of a scene is the sun and casts shadows.
struct Light {
  Vec3 direction = Vec3(-0.5, 0.35, -0.8);  ///< direction in W in which the light travels
  Color color{1.0f, 0.97f, 0.9f, 1.0f};     ///< color of the light

  /// Passes nothing to the visitor: a <light> has only elements of SDF, which the reader of worlds
  /// reads itself.
  void describe(Fields&) {}
};

/// Length and output of a run. All times and rates refer to simulated time.
struct Recording {
  double duration = 60;  ///< maximum duration of the run [s]
  /// Time that the run continues after the last program has ended [s]; up to six times as long
  /// while soil is active.
  double settle = 1.0;
  double telemetry_rate = 50;  ///< rows of telemetry per second
  bool render = true;          ///< true: cameras record images

  /// Passes the fields of <navvy:recording> to the visitor `f`.
  void describe(Fields& f) {
    f("duration_s", duration, {1e-3, 1e6},
      "Longest simulated time; the run ends earlier when every program has ended.");
    f("settle_s", settle, {0, 1e5},
      "Time after the last program ended; up to six times as long while soil is active.");
    f("telemetry_rate_hz", telemetry_rate, {0.01, 1e5}, "Rows of telemetry per simulated second.");
    f("render", render, "Cameras draw images.");
  }
};

/// Maps or messages that a run writes at a fixed rate. They do not influence the run.
struct MapRecord {
  /// Default of `machine_rate` [1/s].
  static constexpr double kMachineRate = 50;

  int line = 0;        ///< line of the record in the scene file, for messages
  std::string name;    ///< name of the written files in the folder of the run
  std::string format;  ///< a format of `navvy map`, or "mcap" or "bag"
  /// Names of the map layers; empty: the default layers of the format.
  std::vector<std::string> layers;
  double rate = 1;  ///< maps per second of simulated time
  /// Rate of poses, joint states and clock in "mcap" and "bag" [1/s]; 0: not given, so kMachineRate
  /// applies.
  double machine_rate = 0;
  std::string layer_names;  ///< `layers` as one text, as in the file

  /// Passes the fields of <navvy:record> to the visitor `f`.
  void describe(Fields& f) {
    f.attribute("name", name, "Name of the files.", kNeeded);
    f("format", format, "A format of `navvy map`, or mcap or bag for ROS 2.", kNeeded);
    f("layers", layer_names, "Layers, separated by blanks; by default those of the format.");
    f("rate_hz", rate, {0.001, 1000}, "Maps per simulated second.");
    f("machine_rate_hz", machine_rate, {0.001, 1000},
      "Rate of poses, joints and clock in mcap and bag; by default 50.");
  }
};

/// A complete scene: everything that determines a run, with references resolved and in SI units.
/// Equal scenes give equal runs on the same device.
struct Scene {
  std::string name;                      ///< name of the scene and of the folder of its results
  std::string file;                      ///< path of the scene file
  Vec3 gravity = Vec3(0, 0, -kGravity);  ///< acceleration of gravity in W [m/s2]
  std::uint64_t seed = 1;   ///< seed of all random numbers: hills and simulated encoder errors
  SolverSettings solver;    ///< settings of the soil solver
  std::vector<Soil> soils;  ///< soils; other structs refer to them by index or name
  StartGround ground;       ///< ground at the start
  Design design;            ///< design surface; it does not influence the run
  Materials materials;      ///< contact properties of rigid bodies
  std::vector<MachineInWorld> machines;  ///< machines
  std::vector<Hitch> hitches;            ///< couplings between machines
  std::vector<Camera> cameras;           ///< cameras that record images
  std::vector<Light> lights;             ///< lights; the first one is the sun
  std::string show;                      ///< names of overlays in pictures, separated by blanks
  Recording recording;                   ///< length and output of the run
  std::vector<MapRecord> records;        ///< maps and messages that the run writes
  Forbidden forbidden;                   ///< events that end the run as failed
  Goals goals;                           ///< bounds on the score of the run

  /// Passes all fields of a scene's <world> to the visitor `f`.
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
    f("navvy:show", show,
      "Overlays in pictures, separated by blanks: joints, hitches, forces, wheel_loads, payload, "
      "design, path, grid, person, hud, and one color of cut_fill, active, density, speed.",
      kShown);
    f("navvy:recording", recording, "Length and output of a run.", kShown);
    f("navvy:record", records, limits::kMachines, "Maps that a run writes at a rate.", kShown);
    f("navvy:forbid", forbidden, "Events that end a run as failed.", kShown);
    f("navvy:goals", goals, "Bounds on the score of a run, which decide its exit status.", kShown);
  }

  /// Returns the index in `soils` of the soil with this name; -1 if there is none.
  int soil_index(const std::string& name_of_soil) const;
  /// Returns the index in `machines` of the machine with this name; -1 if there is none.
  int machine_index(const std::string& name_of_machine) const;
  /// Returns the design that the score of a run compares the ground with: `design`, or if that is
  /// empty the areas that the programs make.
  Design commanded_design() const;
};

}  // namespace navvy::scene
