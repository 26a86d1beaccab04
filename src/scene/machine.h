// SPDX-License-Identifier: Apache-2.0
// A machine as data: links, joints, hydraulics, drive train, tyres, and the shells that touch soil.
// Frames: M is the machine's frame (x forward, y left, z up, origin as in its SDF file), L a
// link's, J a joint's. All values are in SI units and all angles in radians; `describe` documents
// the elements of a file and their units.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/limits.h"
#include "core/math.h"
#include "geometry/triangle_mesh.h"
#include "scene/bucket.h"
#include "scene/drive.h"
#include "scene/fields.h"
#include "scene/material.h"
#include "scene/mechanism.h"
#include "scene/sensor.h"
#include "scene/tool_shell.h"

namespace navvy::scene {

/// Linear RGB color and opacity, each from 0 to 1; a shape with `a` below 1 is drawn transparent.
struct Color {
  float r = 0.7f, g = 0.7f, b = 0.7f, a = 1.0f;
};

/// A shape in its own frame, centred at the origin with its axis along z. Lengths are in metres.
/// Each type uses only some of the members.
struct Geometry {
  /// Type of the shape.
  enum class Kind { kBox, kCylinder, kSphere, kMesh, kPlane, kCone, kCapsule };
  Kind kind = Kind::kBox;    ///< type of the shape
  Vec3 size = Vec3::Ones();  ///< edges of a box; x and y: edges of a plane [m]
  double radius = 0.5;       ///< radius of a cylinder, capsule or sphere, or of a cone's base [m]
  /// Length of a cylinder or cone (tip at +z), or of a capsule without its hemispherical ends [m].
  double length = 1.0;
  /// Absolute path of the file of a mesh; with `made`, a name that is unique for the mesh.
  std::string mesh_file;
  /// Mesh that was computed and is in no file; empty otherwise.
  std::shared_ptr<const geometry::TriangleMesh> made;
  Vec3 scale = Vec3::Ones();  ///< scale factors of a mesh along its x, y and z axes [-]

  /// Passes the parameters of the shape to the visitor `f`; a file gives them in SDF's <geometry>.
  void describe(Fields& f) {
    f.derived_kind("kind", kind);
    f.derived("size", size);
    f.derived("radius", radius);
    f.derived("length", length);
    // The folder of a mesh depends on the installation.
    f.derived_text("mesh", [this] { return std::filesystem::path(mesh_file).filename().string(); });
    f.derived("scale", scale);
  }
};

/// Passes the element with the density [kg/m3] of a link or shape to the visitor `f`.
inline void describe_density(Fields& f, double& density) {
  f("navvy:density_kg_per_m3", density, {1, 25000},
    "Density of the link or shape, from which mass, centre and inertia follow without <inertial>. "
    "Collision shapes count, visuals where there are none; each is solid and counted whole.",
    kShown);
}

/// A shape that is drawn as part of a link. V is the shape's own frame.
struct Visual {
  std::string name;              ///< name of the visual
  Geometry geometry;             ///< the shape
  Pose X_LV = Pose::Identity();  ///< pose of the shape in the link's frame
  Color color;                   ///< color of the shape
  double density = 0;            ///< density for deriving the link's mass [kg/m3]; 0: not given

  /// Passes the fields of a <visual> to the visitor `f`.
  void describe(Fields& f) {
    f.attribute("name", name, "Name of the visual.");
    describe_density(f, density);
  }
};

/// A shape of a link for contact with rigid bodies. C is the shape's own frame. For contact with
/// soil a link has shells instead, so that a bucket needs both.
struct Collision {
  std::string name;              ///< name of the collision
  Geometry geometry;             ///< the shape
  Pose X_LC = Pose::Identity();  ///< pose of the shape in the link's frame
  /// Coulomb coefficient of friction [-]; the physics engine combines the coefficients of two
  /// shapes that touch.
  double friction = 0.8;
  /// True: copied from a visual, as the machine's file has no collision at all.
  bool derived = false;
  double density = 0;  ///< density for deriving the link's mass [kg/m3]; 0: not given

  /// Passes the fields of a <collision> to the visitor `f`.
  void describe(Fields& f) {
    f.attribute("name", name, "Name of the collision.");
    describe_density(f, density);
    geometry.describe(f);
    f.derived("pose", X_LC);
    f.derived("friction", friction);
  }
};

/// A rigid body of a machine, with the link frame L.
struct Link {
  std::string name;              ///< name of the link
  Pose X_ML = Pose::Identity();  ///< pose in the machine's frame with all joints at position zero
  double mass = 1;               ///< mass [kg]
  Vec3 p_LCom = Vec3::Zero();    ///< position of the centre of mass in L [m]
  Mat3 inertia = Mat3::Identity();  ///< inertia about the centre of mass, in the axes of L [kg m2]
  std::vector<Visual> visuals;      ///< shapes that are drawn
  std::vector<Collision> collisions;  ///< shapes for contact with rigid bodies
  /// Material of the link's collisions and shells in contact with rigid bodies.
  LinkMaterial material;
  double density = 0;           ///< density for deriving mass and inertia [kg/m3]; 0: not given
  std::vector<Sensor> sensors;  ///< sensors on the link
  /// Point on which outside components pull; empty: the link has no such input.
  std::optional<ForceInput> force_input;

  /// Passes the fields of a <link> to the visitor `f`.
  void describe(Fields& f) {
    f.attribute("name", name, "Name of the link.");
    f("navvy:material", material.name,
      "Material of the collision shapes and shells, one word. The world's navvy:materials must "
      "hold a pair for all that may touch.");
    describe_density(f, density);
    f("navvy:force_input", force_input,
      "Lets components outside the simulation pull on the link, by the inputs "
      "MACHINE/LINK/external_force_x, _y and _z.");
    f.derived("pose", X_ML);
    f.derived("mass", mass);
    f.derived("centre_of_mass", p_LCom);
    f.derived("inertia", inertia);
    f("visual", visuals, limits::kShapes, "Appearance.", kSdf | kShown);
    f("collision", collisions, limits::kShapes, "Contact shape.", kSdf);
    // Sensors only read the world, so they are no parameters of it.
    f("sensor", sensors, kMostSensors, "Sensor, which reads the world and changes nothing.",
      kSdf | kShown);
  }
};

/// A joint between two links. A positive position is a rotation about `axis` by the right-hand
/// rule, or a translation along `axis`.
struct Joint {
  /// Type of the relative motion; kFixed allows none, kBall all rotations.
  enum class Type { kFixed, kRevolute, kPrismatic, kBall };
  std::string name;               ///< name of the joint
  Type type = Type::kFixed;       ///< type of the joint
  int parent = -1;                ///< index of the parent link in Machine::links; -1: the world
  int child = -1;                 ///< index of the child link in Machine::links
  Pose X_LcJ = Pose::Identity();  ///< pose of the joint frame in the child link's frame
  Vec3 axis = Vec3::UnitZ();      ///< unit vector of the axis, in the joint frame at position zero
  bool has_limits = false;        ///< false: the joint has no position limits
  double lower = 0, upper = 0;    ///< position limits [rad] or [m], if `has_limits`
  double effort = 1e9;    ///< maximum torque [N m] or force [N]; hydraulics may reduce it further
  double velocity = 1e9;  ///< maximum velocity [rad/s] or [m/s]
  double damping = 0;     ///< viscous damping [N m s/rad] or [N s/m]
  double friction = 0;    ///< dry friction torque [N m] or force [N]
  double initial = 0;     ///< position at the start [rad] or [m]
  double brake = 0;       ///< maximum holding torque [N m] or force [N] of the brake; 0: no brake
  double stiffness = 0;   ///< stiffness of the joint's spring [N m/rad] or [N/m]; 0: no spring
  double rest = 0;        ///< position at which the spring is relaxed [rad] or [m]
  /// True: the joint moves freely until it gets a command. False: it holds its position at the
  /// start. `has_passive` is true if the file says so.
  bool passive = false, has_passive = false;
  /// Limits of a ball joint [rad]; pi: unlimited. `cone` is the maximum angle between the child's x
  /// axis and its direction at the start, `twist` the maximum rotation of the child about this axis
  /// in either direction.
  double cone = kPi, twist = kPi;

  /// Passes the fields of a <joint> to the visitor `f`.
  void describe(Fields& f) {
    f.attribute("name", name, "Name of the joint.");
    f.group({"navvy:ball", "Limits of a ball joint.", kShown}, [this](Fields& g) {
      g("cone_deg", cone, {0.1, 180},
        "Largest angle by which the joint's x axis on the child leaves its direction at the "
        "start.");
      g("twist_deg", twist, {0.1, 180}, "Largest turn of the child about this axis, either way.");
    });
    f.group({"navvy:brake",
             "Brake that the input MACHINE/JOINT/brake sets; not for joints of wheels.", kShown},
            [this](Fields& g) {
              g("torque_nm", brake, {1e-3, 1e9}, "Greatest holding torque, of a revolute joint.");
              g("force_n", brake, {1e-3, 1e9}, "Greatest holding force, of a prismatic joint.");
            });
    f("navvy:passive", passive,
      "The joint moves freely until it gets a command. By default false, and true for joints with "
      "a spring or a gear to follow, and joints of loops without a limit of effort.",
      given(has_passive));
    if (stiffness > 0) f.derived("stiffness", stiffness);
    if (stiffness > 0) f.derived("rest", rest);
    f.derived_kind("type", type);
    f.derived("parent", parent);
    f.derived("child", child);
    f.derived("pose", X_LcJ);
    f.derived("axis", axis);
    f.derived("has_limits", has_limits);
    f.derived("lower", lower);
    f.derived("upper", upper);
    f.derived("effort", effort);
    f.derived("velocity", velocity);
    f.derived("damping", damping);
    f.derived("friction", friction);
    f.derived("initial", initial);
    f.derived("brake", brake);
    f.derived("cone", cone);
    f.derived("twist", twist);
  }
};

/// Position of a joint at the start, given by a machine file or by a scene that includes the
/// machine.
struct InitialPosition {
  std::string joint;  ///< name of the joint
  double angle = 0;   ///< position of a revolute joint [rad]
  double length = 0;  ///< position of a prismatic joint [m]
  /// True if `angle` was given, and true if `length` was given.
  bool has_angle = false, has_length = false;

  /// Passes the fields of a <navvy:joint> to the visitor `f`.
  void describe(Fields& f) {
    f.attribute("name", joint, "Joint of the machine.");
    f("initial_deg", angle, {-3600, 3600}, "Position of a revolute joint.", given(has_angle));
    f("initial_m", length, {-1000, 1000}, "Position of a prismatic joint.", given(has_length));
  }
};

/// A hydraulic cylinder, or several equal ones side by side, that moves one joint. Its length and
/// lever arm follow from the positions of its two pins, or from a four-bar linkage. The pump fills
/// the head side when the cylinder extends. Pressures give forces by the areas of piston and rod,
/// and forces give joint torques by the lever arm at each joint position
/// [docs/machines.md, hydraulics].
struct Cylinder {
  std::string name;   ///< name of the cylinder
  std::string joint;  ///< name of the joint that the cylinder moves
  /// Names of the links that carry the pins of the barrel and of the rod.
  std::string base_link, rod_link;
  Vec3 p_base = Vec3::Zero();  ///< pin of the barrel in the frame of `base_link` [m]
  /// Pin of the rod in the frame of `rod_link` [m]; unused with a linkage.
  Vec3 p_rod = Vec3::Zero();
  /// True: a four-bar linkage transmits the motion. The rod turns a rocker on `base_link`, and a
  /// coupler connects the rocker with `rod_link`.
  bool has_linkage = false;
  Vec3 p_rocker = Vec3::Zero();  ///< pivot of the rocker in the frame of `base_link` [m]
  /// Distances from the rocker's pivot to the rod and to the coupler [m].
  double rocker_rod = 0, rocker_coupler = 0;
  double coupler = 0;               ///< length of the coupler [m]
  Vec3 p_coupler = Vec3::Zero();    ///< pin of the coupler in the frame of `rod_link` [m]
  int count = 1;                    ///< number of equal cylinders side by side
  double bore = 0.12, rod = 0.085;  ///< diameters of the piston and of the rod [m]
  double pressure = 35e6;           ///< relief pressure: maximum oil pressure [Pa]
  /// Distance between the axes of cylinders side by side [m]; only for drawing.
  double spacing = 0.68;
  double flow = 0.004;  ///< maximum oil flow into all `count` cylinders together [m3/s]

  /// Passes the fields of a <navvy:cylinder> to the visitor `f`.
  void describe(Fields& f) {
    f.attribute("name", name, "Name of the cylinder.", kNeeded);
    f("joint", joint, Refers::kJoint, "Joint that the cylinder moves.", kNeeded);
    f("base_link", base_link, Refers::kLink, "Link that carries the pin of the barrel.", kNeeded);
    f("base_pin_m", p_base, "Pin of the barrel in the frame of base_link.", kNeeded);
    f("rod_link", rod_link, Refers::kLink, "Link that carries the pin of the rod.", kNeeded);
    f("rod_pin_m", p_rod, "Pin of the rod in the frame of rod_link; not with a linkage.");
    f.group({"linkage", "Four-bar linkage between rod and rod_link.", given(has_linkage)},
            [this](Fields& g) {
              g("rocker_pin_m", p_rocker, "Pivot of the rocker on base_link.", kNeeded);
              g("rocker_to_rod_m", rocker_rod, {0.01, 10}, "From that pivot to the rod.", kNeeded);
              g("rocker_to_coupler_m", rocker_coupler, {0.01, 10},
                "From that pivot to the coupler.", kNeeded);
              g("coupler_length_m", coupler, {0.01, 10}, "Length of the coupler.", kNeeded);
              g("coupler_pin_m", p_coupler, "Pin of the coupler on rod_link.", kNeeded);
            });
    f("count", count, {1, 8}, "Number of equal cylinders side by side.");
    f("bore_m", bore, {0.005, 1}, "Diameter of the piston.");
    f("rod_m", rod, {0.002, 1}, "Diameter of the rod, less than that of the piston.");
    f("pressure_pa", pressure, {1e5, 1e8}, "Relief pressure.");
    f("flow_m3_per_s", flow, {1e-7, 1}, "Greatest flow of oil for this function.");
  }
};

/// The load-sensing pump that supplies all cylinders of a machine. If the valves demand more than
/// the pump's flow or power, all cylinders slow down by the same factor [docs/machines.md, pump].
struct Pump {
  double flow = 0;   ///< maximum oil flow [m3/s]
  double power = 0;  ///< maximum flow x pressure [W]

  /// Passes the fields of a <navvy:pump> to the visitor `f`.
  void describe(Fields& f) {
    f("flow_m3_per_s", flow, {1e-7, 10}, "Greatest flow of oil.", kNeeded);
    f("power_w", power, {0.1, 1e7}, "Greatest flow x pressure.", kNeeded);
  }
};

/// Track of a crawler. It runs around a sprocket, an idler and the rollers between them, which
/// press the lower run of the track on the ground; it does not stretch [docs/machines.md, tracks].
/// All points are given in the frame of the parent link of the sprocket's joint, with x forward and
/// z up.
struct Track {
  Vec3 p_idler = Vec3::Zero();  ///< centre of the idler [m]
  double idler_radius = 0.35;   ///< radius of the idler's rim [m]
  std::vector<Vec3> rollers;    ///< centres of the rollers, from front to rear [m]
  double roller_radius = 0.1;   ///< radius of a roller's rim [m]
  double thickness = 0.05;      ///< thickness of the track between rim and ground [m]

  /// Passes the fields of the track itself to the visitor `f`; Wheel::describe adds those of the
  /// sprocket.
  void describe(Fields& f) {
    f("idler_m", p_idler, "Middle of the idler.", kNeeded);
    f("idler_radius_m", idler_radius, {0.01, 5}, "Radius of the idler's rim.", kNeeded);
    f("roller_m", rollers, {-1e3, 1e3},
      "Middle of a roller between idler and sprocket; two or more, all at about one height.",
      kNeeded);
    f("roller_radius_m", roller_radius, {0.005, 5}, "Radius of a roller's rim.", kNeeded);
    f("thickness_m", thickness, {0, 1}, "Thickness of the track, from rim to ground.");
  }
  /// Returns the front and the rear end of the lower run: the points on the ground below the first
  /// and the last roller [m].
  std::array<Vec3, 2> lower_run() const {
    const Vec3 down(0, 0, -roller_radius - thickness);
    return {Vec3(rollers.front() + down), Vec3(rollers.back() + down)};
  }
};

/// A tyre, a pair of twin tyres treated as one, or the sprocket of a track. The forces of a tyre on
/// the ground follow from its own law, from pressure, slip and load [docs/machines.md, tyres]; soil
/// that a tyre compacts permanently forms a rut [docs/machines.md, ruts].
struct Wheel {
  std::string joint;        ///< name of the joint that spins the wheel
  std::string steer_joint;  ///< name of the joint that steers the wheel; empty: not steered
  bool driven = false;      ///< true: the drive turns the wheel
  double radius = 0.525;    ///< radius of the unloaded tyre, or of the sprocket's rim [m]
  double width = 0.28;      ///< width of one tyre, or of the track [m]
  double twin_spacing = 0;  ///< distance between the middles of twin tyres [m]; 0: single tyre
  /// Radial stiffness of the wheel or twin pair, or of all rollers of a track [N/m].
  double stiffness = 1.2e6;
  double damping = 1.5e4;  ///< radial damping that acts in parallel with the stiffness [N s/m]
  double friction = 0.8;   ///< coefficient of friction on firm ground [-]
  double rolling_resistance = 0.02;  ///< rolling resistance / load [-]
  /// The track that a sprocket drives; empty for a tyre.
  std::optional<Track> track;
  std::string name;  ///< name of the wheel, for readers of the file

  /// Returns a sprocket with default values for a machine with a mass of 18 t (U).
  static Wheel sprocket() {
    Wheel wheel;
    wheel.driven = true;
    wheel.width = 0.6;
    wheel.stiffness = 1.2e7;
    wheel.damping = 1.2e5;
    wheel.radius = 0.35;
    wheel.track.emplace();
    return wheel;
  }
  /// Passes the fields of a <navvy:wheel> to the visitor `f`; if the wheel has a track, those of a
  /// <navvy:track>.
  void describe(Fields& f) {
    f.attribute("name", name, "Name of the wheel, for the reader of the file.", kShown);
    if (track) {
      f("joint", joint, Refers::kJoint,
        "Joint that spins the sprocket about y of the link that carries the track.", kNeeded);
      f("sprocket_radius_m", radius, {0.01, 5}, "Radius of the sprocket's rim.", kNeeded);
      track->describe(f);
    } else {
      f("joint", joint, Refers::kJoint, "Joint that spins the wheel.", kNeeded);
      f("steer_joint", steer_joint, Refers::kJoint, "Joint that steers the wheel.");
      f("driven", driven, "The drive turns the wheel.");
      f("radius_m", radius, {0.01, 5}, "Radius of the tyre without load.");
      f("twin_spacing_m", twin_spacing, {0, 5},
        "Distance of the middles of twin tyres; 0: single.");
    }
    f("width_m", width, {0.005, 5}, "Width of one tyre, or of the track.");
    f("stiffness_n_per_m", stiffness, {100, 1e9},
      "Radial stiffness of the wheel or pair, or of all rollers together.");
    f("damping_n_s_per_m", damping, {0, 1e8}, "Damping beside the stiffness.");
    f("friction", friction, {0, 3}, "Coefficient of friction on firm ground.");
    f("rolling_resistance", rolling_resistance, {0, 1}, "Rolling resistance / load.");
  }
};

/// An incremental encoder on a revolute joint: a counter with a limited number of bits that wraps
/// around, as a robot's hardware reports it to the controller [docs/machines.md, encoders]. It can
/// simulate measurement errors.
struct Encoder {
  std::string joint;              ///< name of the joint
  double counts_per_turn = 4096;  ///< number of counts per turn of the joint, gears included
  int bits = 16;                  ///< number of bits of the counter, which wraps around at 2^bits
  double slip = 0;                ///< simulated error: longitudinal slip in the counts [-]
  double missed = 0;  ///< simulated error: fraction of the counts that are lost at random

  /// Passes the fields of a <navvy:encoder> to the visitor `f`.
  void describe(Fields& f) {
    f("joint", joint, Refers::kJoint, "Revolute or continuous joint; one encoder per joint.",
      kNeeded);
    f("counts_per_turn", counts_per_turn, {1, 1e7}, "Counts per turn of the joint, gears included.",
      kNeeded);
    f("bits", bits, {2, 32}, "Width of the counter, which wraps at 2^bits.");
    // Beyond this range a wheel would turn ten times as far as it rolls.
    f("slip", slip, {-0.9, 0.9}, "Fault: longitudinal slip s = 1 - v / (w r) in the counts.");
    f("missed", missed, {0, 1}, "Fault: share of the counts that are lost at random.");
  }
};

/// The two levers of an excavator's operator.
struct Levers {
  /// Assignment of the levers to the joints: [ISO 10968], or the pattern of backhoes, which
  /// exchanges boom and stick.
  enum class Pattern { kIso, kSae };
  bool given = false;               ///< true: the machine's file describes the levers
  Pattern pattern = Pattern::kIso;  ///< assignment of the levers to the joints
  /// Fraction of the travel from the middle, in either direction, without effect.
  double dead_band = 0.05;

  /// Passes the fields of <navvy:levers> to the visitor `f`.
  void describe(Fields& f) {
    f("pattern", pattern, {{"iso", Pattern::kIso}, {"sae", Pattern::kSae}},
      "Assignment of the levers to the joints.");
    f("dead_band", dead_band, {0, 0.5},
      "Share of a lever's travel on either side of the middle that opens no valve.");
  }
};

/// Marks a link as a container that tips its load: a dumper's bed or a skip. A machine has at most
/// one.
struct Bed {
  std::string link;       ///< name of the bed's link
  std::string shell;      ///< name of the bed's shell, which is on the same link
  std::string joint;      ///< name of the revolute joint that tips the bed
  double capacity = 3.0;  ///< struck capacity, level with the rim [m3]
  std::string name;       ///< name of the bed, for readers of the file

  /// Passes the fields of a <navvy:bed> to the visitor `f`.
  void describe(Fields& f) {
    f.attribute("name", name, "Name of the bed, for the reader of the file.", kShown);
    f("link", link, Refers::kLink, "Link of the bed.", kNeeded);
    f("shell", shell, Refers::kShell, "Shell of the bed, on the same link.", kNeeded);
    f("joint", joint, Refers::kJoint, "Revolute joint that tips the bed.", kNeeded);
    f("capacity_m3", capacity, {1e-4, 1000}, "Struck capacity, level with the rim.");
  }
};

/// Names of the joints of an excavator's arm by their functions; empty where the machine has none.
struct Arm {
  /// Joints that turn the upper structure relative to the chassis (`swing`), the boom relative to
  /// the upper structure (`boom`), the stick relative to the boom (`stick`) and the bucket relative
  /// to the stick (`bucket`).
  std::string swing, boom, stick, bucket;

  /// Passes the fields of <navvy:arm> to the visitor `f`.
  void describe(Fields& f) {
    f("swing_joint", swing, Refers::kJoint, "Upper structure about the chassis.");
    f("boom_joint", boom, Refers::kJoint, "Boom about the upper structure.");
    f("stick_joint", stick, Refers::kJoint, "Stick about the boom.");
    f("bucket_joint", bucket, Refers::kJoint, "Bucket about the stick.");
  }
};

/// Limits of the ground on which a machine can drive, for maps and path planning (U).
struct Traversability {
  bool given = false;          ///< true: the machine's file gives them
  double slope = radians(30);  ///< maximum slope [rad]
  /// Maximum height of a step (`step_height`) and maximum rms deviation of the surface from a plane
  /// (`roughness`), each within the window [m].
  double step_height = 0.30, roughness = 0.10;
  double window = 0.20;  ///< half of the edge of the square window [m]

  /// Passes the fields of <navvy:traversability> to the visitor `f`.
  void describe(Fields& f) {
    f("slope_deg", slope, {1, 89}, "Steepest slope.");
    f("step_m", step_height, {0.001, 100}, "Highest step within the window.");
    f("roughness_m", roughness, {0.001, 100}, "Greatest rms deviation from a plane in the window.");
    f("window_m", window, {0.01, 10}, "Half the side of the square window.");
  }
};

/// A machine as described by one SDF file. MachineInWorld adds its position in a scene and its
/// program. Indices refer to the lists of this struct and are valid until an item is inserted.
struct Machine {
  std::string name;  ///< name of the machine
  std::string file;  ///< path of the SDF file that describes the machine
  /// True: joints follow their commands exactly, without masses and forces.
  bool kinematic = false;
  bool fixed_base = false;  ///< true: the base is fixed to the world
  /// Links in tree order: links[0] is the base, and every parent comes before its children. The
  /// child of joint i is link i + 1.
  std::vector<Link> links;
  std::vector<Joint> joints;        ///< joints, one per link except the base
  std::vector<JointGear> gears;     ///< fixed ratios between two joints
  std::vector<LoopJoint> loops;     ///< joints that close loops of links
  std::vector<Cylinder> cylinders;  ///< hydraulic cylinders
  /// False: every cylinder has a flow of its own, independent of the others.
  bool has_pump = false;
  Pump pump;                      ///< the pump, if `has_pump`
  std::vector<Wheel> wheels;      ///< tyres and sprockets
  bool has_drive = false;         ///< false: wheels turn freely, or as commanded at their joints
  Drive drive;                    ///< the drive, if `has_drive`
  std::vector<Shell> shells;      ///< surfaces that touch soil
  std::vector<Bucket> buckets;    ///< digging buckets
  std::vector<Bed> beds;          ///< tipping containers, at most one
  Arm arm;                        ///< joints of an excavator's arm
  Traversability traversability;  ///< limits of the ground on which the machine can drive
  std::vector<Encoder> encoders;  ///< incremental encoders, at most one per joint
  Levers levers;                  ///< operator's levers
  /// True: without any collision in the file, visuals serve as collisions.
  bool derive_collisions = true;
  /// Positions of joints at the start, from the machine's file.
  std::vector<InitialPosition> initial_positions;
  /// Sentences for people that report which collisions were copied from visuals and which masses
  /// were computed from densities.
  std::vector<std::string> derived;

  /// Passes the fields of a machine's <model> to the visitor `f`.
  void describe(Fields& f) {
    f("navvy:physics", kinematic, {{"dynamic", false}, {"kinematic", true}},
      "Physics: masses and forces, or motion exactly as commanded; an engine is a part of "
      "navvy:drive.");
    f("navvy:derive_collisions", derive_collisions,
      "Visuals collide in a model without any collision, except planes and links with a shell or "
      "tyre.",
      kShown);
    f.derived("fixed_base", fixed_base);
    f("link", links, limits::kLinks, "Rigid body.", kSdf);
    f("joint", joints, limits::kLinks, "Joint between two links.", kSdf);
    f.derived_list("gear", gears);
    f.derived_list("loop", loops);
    f("navvy:joint", initial_positions, limits::kLinks, "Position of a joint at the start.",
      kShown);
    f("navvy:arm", arm, "Joints of an excavator's arm by their roles.");
    f("navvy:cylinder", cylinders, limits::kLinks, "Hydraulic cylinder on one joint.");
    f("navvy:pump", pump,
      "Load-sensing pump that all cylinders share; without it each has its own.", given(has_pump));
    f.list("wheel", wheels, limits::kLinks,
           std::vector<Start<Wheel>>{
               {"navvy:wheel", "Tyre, or twin pair of tyres.", Wheel()},
               {"navvy:track", "Track of a crawler, one per side, with a differential drive.",
                Wheel::sprocket()}});
    f.group({"navvy:drive", "Drive of the wheels or tracks.", given(has_drive)},
            [this](Fields& g) { describe_drive(g, drive); });
    f("navvy:shell", shells, limits::kShells, "Steel that touches soil, as a thin shell.");
    f("navvy:bucket", buckets, limits::kShells, "Makes a link a digging bucket.");
    f("navvy:bed", beds, limits::kShells, "Makes a link a container that tips its load.");
    f("navvy:encoder", encoders, limits::kLinks, "Counter of the turns of a joint.");
    f("navvy:levers", levers,
      "Two levers for the joints of the arm; a joint without a cylinder needs a velocity limit.",
      given(levers.given));
    f("navvy:traversability", traversability, "Limits of the ground that the machine can drive on.",
      given(traversability.given));
  }

  /// Returns the mass of all links [kg].
  double total_mass() const;
  /// Returns the index of the link with this name in `links`; -1 if there is none.
  int link_index(const std::string& name_of_link) const;
  /// Returns `shell`, a shell of this machine, with the cutting edge and the teeth of the bucket
  /// that it belongs to.
  Shell with_teeth(const Shell& shell) const;
  /// Returns the index of the joint with this name in `joints`; -1 if there is none.
  int joint_index(const std::string& name_of_joint) const;
  /// Returns true if any link carries a sensor.
  bool has_sensors() const;
  /// Returns true if the shell with index `shell` belongs to a digging bucket.
  bool is_bucket(int shell) const;
  /// Returns true if the shell with index `shell` belongs to a tipping container.
  bool is_bed(int shell) const;
};

}  // namespace navvy::scene
