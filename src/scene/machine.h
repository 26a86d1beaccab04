// SPDX-License-Identifier: Apache-2.0
// A machine as data: links, joints, hydraulics, drive train, tyres and the shells that touch soil.
// Frames: M machine (x forward, y left, z up, at the ground under the rear axle or as its SDF
// says), L link, J joint.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/math.h"
#include "geometry/triangle_mesh.h"
#include "scene/drive.h"
#include "scene/material.h"

namespace navvy::scene {

/// Linear RGB and alpha, 0 to 1; alpha below 1 is drawn transparent.
struct Color {
  float r = 0.7f, g = 0.7f, b = 0.7f, a = 1.0f;
};

/// A shape about its own origin. Members that its kind does not use are ignored; lengths in metres.
struct Geometry {
  enum class Kind { kBox, kCylinder, kSphere, kMesh, kPlane, kCone, kCapsule };
  Kind kind = Kind::kBox;
  Vec3 size = Vec3::Ones();  ///< box edges [m]; plane: x, y
  double radius = 0.5;       ///< cylinder, capsule (axis z), sphere, a cone's foot [m]
  /// Cylinder, cone (tip at +z); capsule: between the middles of its caps [m].
  double length = 1.0;
  std::string mesh_file;  ///< absolute path of an OBJ file
  // For meshes: factors along the file's axes.
  Vec3 scale = Vec3::Ones();
};

/// What a link looks like. V is the visual's frame; nothing here touches anything.
struct Visual {
  std::string name;
  Geometry geometry;
  Pose X_LV = Pose::Identity();
  Color color;
};

/// What a link touches rigid bodies with. Soil is touched by shells instead, so a bucket has both.
struct Collision {
  std::string name;
  Geometry geometry;
  Pose X_LC = Pose::Identity();
  // Coulomb coefficient of this surface [-]; how two that touch combine is the engine's rule.
  double friction = 0.8;
  bool derived = false;  ///< from a visual, as the machine's file gave no collision
};

/// A rigid body of a machine. `p_LCom` is a point of L; the inertia is about that point, in L's
/// axes.
struct Link {
  std::string name;
  Pose X_ML = Pose::Identity();     ///< at zero joint positions
  double mass = 1;                  ///< [kg]
  Vec3 p_LCom = Vec3::Zero();       ///< centre of mass [m]
  Mat3 inertia = Mat3::Identity();  ///< about the centre of mass, axes of L [kg m2]
  std::vector<Visual> visuals;
  std::vector<Collision> collisions;
  LinkMaterial material;  ///< of its collisions and of its shells against bodies
};

/// Two links and how one moves against the other. Positive is about or along `axis` by the right
/// hand.
struct Joint {
  enum class Type { kFixed, kRevolute, kPrismatic, kBall };
  std::string name;
  Type type = Type::kFixed;
  int parent = -1;  ///< index into Machine::links; -1 = world
  int child = -1;
  Pose X_LcJ = Pose::Identity();  ///< joint frame in the child link
  Vec3 axis = Vec3::UnitZ();      ///< unit, in the joint frame at zero position
  bool has_limits = false;        ///< false: continuous
  double lower = 0, upper = 0;    ///< [rad] or [m]
  double effort = 1e9;            ///< [N m] or [N]; hydraulics may limit further
  double velocity = 1e9;          ///< [rad/s] or [m/s]
  // Of the joint's speed: [N m s/rad] or [N s/m], and dry friction [N m] or [N].
  double damping = 0, friction = 0;
  double initial = 0;  ///< position at the start
  /// Most that its brake holds, which a command puts on [N m] or [N]; 0: it has none.
  double brake = 0;
  /// Of a ball: how far the joint's x axis on the child may lean from where it points at the start,
  /// and how far the child may turn about it either way [rad]; pi is free.
  double cone = kPi, twist = kPi;
};

/// A hydraulic cylinder acting on one joint. Length and lever arm follow from two pins, or from a
/// four-bar linkage. The pump fills the head side when the cylinder extends. Pressures become
/// forces by bore and rod, forces become joint torques by the lever arm, which the geometry gives
/// at every position [docs/machines.md, hydraulics].
struct Cylinder {
  std::string name;
  std::string joint;
  std::string base_link, rod_link;  ///< links that carry the pins
  Vec3 p_base = Vec3::Zero();       ///< pin on base_link, in that link's frame [m]
  Vec3 p_rod = Vec3::Zero();        ///< pin on rod_link [m] (without a linkage)
  /// Rod pin sits on a rocker that pushes a coupler to the bucket.
  bool has_linkage = false;
  Vec3 p_rocker = Vec3::Zero();               ///< rocker pivot on base_link [m]
  double rocker_rod = 0, rocker_coupler = 0;  ///< pivot to rod pin, pivot to coupler pin [m]
  double coupler = 0;                         ///< coupler length [m]
  Vec3 p_coupler = Vec3::Zero();              ///< coupler pin on rod_link (the bucket) [m]
  int count = 1;                              ///< cylinders side by side
  double bore = 0.12, rod = 0.085;            ///< [m]
  double pressure = 35e6;                     ///< relief [Pa]
  /// Between the middles of cylinders side by side, for pictures [m].
  double spacing = 0.68;
  double flow = 0.004;  ///< most oil for this function [m3/s]
};

/// The pump that all cylinders of a machine share. Cylinders that ask for more than it can give
/// share it [docs/machines.md, pump].
struct Pump {
  double flow = 0;   ///< most oil at any pressure it can drive [m3/s]
  double power = 0;  ///< flow x pressure at most [W]
};

/// The belt of a crawler. It runs round a sprocket, an idler and the rollers between them, which
/// press its lower run on the ground; it does not stretch [docs/machines.md, tracks]. Points are in
/// the frame of the link that carries it, the parent of the sprocket's joint, x ahead and z up.
struct Track {
  Vec3 p_idler = Vec3::Zero();  ///< middle of the idler [m]
  double idler_radius = 0.35;   ///< [m]
  std::vector<Vec3> rollers;    ///< middles, from the foremost to the last, two at least [m]
  double roller_radius = 0.1;   ///< [m]
  /// Of the belt, from the rims of wheels and rollers to the ground [m].
  double thickness = 0.05;

  /// Where the lower run ends: on the ground under the first and the last roller [m].
  std::array<Vec3, 2> lower_run() const {
    const Vec3 down(0, 0, -roller_radius - thickness);
    return {Vec3(rollers.front() + down), Vec3(rollers.back() + down)};
  }
};

/// A tyre (or a twin pair as one) with its own force law on the ground. Its forces come from
/// pressure, slip and load [docs/machines.md, tyres]; what it presses for good is a rut
/// [docs/machines.md, ruts].
struct Wheel {
  std::string joint;        ///< spin joint
  std::string steer_joint;  ///< empty: not steered
  bool driven = false;
  double radius = 0.525;             ///< [m]
  double width = 0.28;               ///< of one tyre [m]
  double twin_spacing = 0;           ///< centre to centre; 0 = single tyre [m]
  double stiffness = 1.2e6;          ///< radial, per wheel (pair) [N/m]
  double damping = 1.5e4;            ///< [N s/m]
  double friction = 0.8;             ///< tyre on firm ground [-]
  double rolling_resistance = 0.02;  ///< share of the load [-]
  /// It is the sprocket of a crawler's belt: radius is that of its rim, width the belt's, stiffness
  /// and damping those of all rollers together.
  std::optional<Track> track;
};

/// An incremental encoder on a joint that turns: a counter of a few bits that wraps, as a real
/// robot hands it to its controller [docs/machines.md, encoders]. It measures the joint and may be
/// told to measure wrongly.
struct Encoder {
  std::string joint;
  double counts_per_turn = 4096;  ///< of the joint, gears included [1]
  int bits = 16;                  ///< of the counter: it goes from 0 to 2^bits - 1
  /// Longitudinal slip that the counts pretend, s = 1 - v / (w r) [-].
  double slip = 0;
  double missed = 0;  ///< share of the counts that are lost, by chance [-]
};

/// Two levers of an excavator's operator, [ISO 10968] or the pattern of backhoes with boom and
/// stick exchanged.
struct Levers {
  enum class Pattern { kIso, kSae };
  bool given = false;  ///< by the machine's file
  Pattern pattern = Pattern::kIso;
  /// Share of a lever's way either side of its middle that opens no valve [-].
  double dead_band = 0.05;
};

/// A thin shell of triangles, in the link frame [m], that touches soil: a bucket, blade, plate,
/// bed. The triangles' front is the inside. Edges used by one triangle only are free edges (lip,
/// rim). It has two sides and a thickness and may be open: what it holds is the soil on its front
/// [docs/tools.md, shells].
struct Shell : geometry::TriangleMesh {
  std::string name;
  std::string link;
  double half_thickness = 0.015;  ///< [m]
  // What of a soil's tool friction (its tangent) and adhesion this surface has; 0 = smooth, no
  // shear at all.
  double friction_share = 1, adhesion_share = 1;
};

/// What makes a link a digging bucket. Operators use it to know where the edge points; soil knows
/// only the shell.
struct Bucket {
  std::string link;
  std::string shell;
  double capacity = 0.8;      ///< heaped [m3]
  double width = 1.05;        ///< of the cut [m]
  Vec3 p_tip = Vec3::Zero();  ///< centre of the cutting edge, link frame [m]
  /// Unit, link frame: the way the edge points (along the floor, outward).
  Vec3 cut_direction = Vec3::UnitX();
  Vec3 opening = Vec3::UnitZ();  ///< unit, link frame: out of the mouth
};

/// What makes a link a container that tips its load: a dumper's bed, a skip. The struck volume is
/// that level with the rim.
struct Bed {
  std::string link;
  std::string shell;
  std::string joint;      ///< tips it
  double capacity = 3.0;  ///< struck [m3]
};

/// The joints of an excavator's arm by their roles: names of joints, empty where the machine has
/// none.
struct Arm {
  std::string swing;   ///< upper structure about the chassis
  std::string boom;    ///< boom about the upper structure
  std::string stick;   ///< stick about the boom
  std::string bucket;  ///< bucket about the stick
};

/// What a machine can drive on; maps for planners grade the ground by it.
struct Traversability {
  bool given = false;                           ///< by the machine's file
  double slope = radians(30);                   ///< [rad] (U)
  double step_height = 0.30, roughness = 0.10;  ///< [m] (U)
  /// Half the side of the square that both look at [m].
  double window = 0.20;
};

/// A machine as data, as one SDF file describes it; where it stands and what it does is in
/// MachineInWorld. Indices refer to the lists here and hold as long as nothing is inserted.
struct Machine {
  std::string name;
  std::string file;        ///< SDF it came from
  bool kinematic = false;  ///< moved by joint positions only, no dynamics ("engine" kinematic)
  bool fixed_base = false;
  // Every parent stands before its children, and joint i moves link i + 1.
  std::vector<Link> links;  ///< links[0] is the base
  std::vector<Joint> joints;
  std::vector<Cylinder> cylinders;
  bool has_pump = false;  ///< false: every cylinder has its own flow
  Pump pump;
  std::vector<Wheel> wheels;
  bool has_drive = false;  ///< false: wheels turn freely, or as their joints are commanded
  Drive drive;
  std::vector<Shell> shells;
  std::vector<Bucket> buckets;
  std::vector<Bed> beds;
  Arm arm;
  Traversability traversability;
  std::vector<Encoder> encoders;  ///< one a joint at most
  Levers levers;
  // What the file leaves to be derived, in words: collision shapes from visuals, masses from
  // densities.
  std::vector<std::string> derived;

  /// Index by name, -1 when there is none. The search is linear: names are resolved once, at the
  /// start.
  int link_index(const std::string& name_of_link) const;
  int joint_index(const std::string& name_of_joint) const;
  /// What a shell is for, by its index: the first holds soil that is dug, the second soil that is
  /// carried.
  bool is_bucket(int shell) const;
  bool is_bed(int shell) const;
};

}  // namespace navvy::scene
