// SPDX-License-Identifier: Apache-2.0
// A machine as data: links, joints, hydraulics, drive train, tyres and the shells that touch soil.
// Frames: M machine (x forward, y left, z up; the SDF file defines its origin), L link, J joint.
// All values are in SI units, angles in radians. The `describe` function of each struct documents
// the values that a file gives.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/limits.h"
#include "core/math.h"
#include "geometry/triangle_mesh.h"
#include "scene/drive.h"
#include "scene/fields.h"
#include "scene/material.h"

namespace navvy::scene {

/// Linear RGB and alpha, 0 to 1; alpha below 1 is drawn transparent.
struct Color {
  float r = 0.7f, g = 0.7f, b = 0.7f, a = 1.0f;
};

/// A geometric shape about its own origin, in metres. Each type uses only some of the members.
struct Geometry {
  enum class Kind { kBox, kCylinder, kSphere, kMesh, kPlane, kCone, kCapsule };
  Kind kind = Kind::kBox;
  /// Edge lengths of a box [m]; x and y of a plane.
  Vec3 size = Vec3::Ones();
  /// Radius of a cylinder, capsule or sphere, or of a cone's base [m].
  double radius = 0.5;
  /// Length along z [m]: of a cylinder or cone (tip at +z), or of a capsule without its
  /// hemispheres.
  double length = 1.0;
  /// Absolute path of the OBJ file of a mesh.
  std::string mesh_file;
  /// Scale factors along the mesh file's axes.
  Vec3 scale = Vec3::Ones();

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

/// Visits the density element that links, visuals and collisions may have [kg/m3].
inline void describe_density(Fields& f, double& density) {
  f("navvy:density_kg_per_m3", density, {1, 25000},
    "Density of the link or shape, from which mass, centre and inertia follow without <inertial>. "
    "Collision shapes count, visuals where there are none; each is solid and counted whole.",
    kShown);
}

/// Visible shape of a link. X_LV takes the visual's frame V to the link frame L.
struct Visual {
  std::string name;
  Geometry geometry;
  Pose X_LV = Pose::Identity();
  Color color;
  double density = 0;  ///< [kg/m3]; 0: not given

  void describe(Fields& f) {
    f.attribute("name", name, "Name of the visual.");
    describe_density(f, density);
  }
};

/// Contact shape of a link for contact with other rigid bodies. (Soil touches shells instead, so a
/// bucket has both.) X_LC takes the shape's frame C to the link frame L.
struct Collision {
  std::string name;
  Geometry geometry;
  Pose X_LC = Pose::Identity();
  /// Coulomb friction coefficient [-]. The physics engine combines the coefficients of two shapes
  /// in contact.
  double friction = 0.8;
  /// True if the shape was copied from a visual because the machine's file has no collision shapes.
  bool derived = false;
  double density = 0;  ///< [kg/m3]; 0: not given

  void describe(Fields& f) {
    f.attribute("name", name, "Name of the collision.");
    describe_density(f, density);
    geometry.describe(f);
    f.derived("pose", X_LC);
    f.derived("friction", friction);
  }
};

/// A rigid body of a machine. `p_LCom` is a position in the link frame L; `inertia` is about that
/// position, in the axes of L.
struct Link {
  std::string name;
  /// Pose of the link in the machine frame M when all joint positions are zero.
  Pose X_ML = Pose::Identity();
  /// Mass [kg].
  double mass = 1;
  /// Position of the centre of mass in L [m].
  Vec3 p_LCom = Vec3::Zero();
  /// Inertia tensor about the centre of mass, in the axes of L [kg m2].
  Mat3 inertia = Mat3::Identity();
  std::vector<Visual> visuals;
  std::vector<Collision> collisions;
  /// Material for contacts of the link's collision shapes and shells with other bodies.
  LinkMaterial material;
  double density = 0;  ///< [kg/m3]; 0: not given

  void describe(Fields& f) {
    f.attribute("name", name, "Name of the link.");
    f("navvy:material", material.name,
      "Material of the collision shapes and shells, one word. The world's navvy:materials must "
      "hold a pair for all that may touch.");
    describe_density(f, density);
    f.derived("pose", X_ML);
    f.derived("mass", mass);
    f.derived("centre_of_mass", p_LCom);
    f.derived("inertia", inertia);
    f("visual", visuals, limits::kShapes, "Appearance.", kSdf | kShown);
    f("collision", collisions, limits::kShapes, "Contact shape.", kSdf);
  }
};

/// A joint between two links. A positive position is a rotation about `axis` (right-hand rule) or a
/// displacement along it.
struct Joint {
  enum class Type { kFixed, kRevolute, kPrismatic, kBall };
  std::string name;
  Type type = Type::kFixed;
  /// Index of the parent link in Machine::links; -1 for the world.
  int parent = -1;
  int child = -1;
  /// Pose of the joint frame J in the child link's frame Lc.
  Pose X_LcJ = Pose::Identity();
  /// Unit vector of the joint axis in J, at joint position zero.
  Vec3 axis = Vec3::UnitZ();
  /// False if the joint can move without limits.
  bool has_limits = false;
  /// Limits of the joint position [rad] or [m].
  double lower = 0, upper = 0;
  /// Maximum torque [N m] or force [N]. A hydraulic cylinder may limit it further.
  double effort = 1e9;
  /// Maximum speed [rad/s] or [m/s].
  double velocity = 1e9;
  /// Viscous damping [N m s/rad] or [N s/m].
  double damping = 0;
  /// Dry friction torque [N m] or force [N].
  double friction = 0;
  /// Joint position at the start [rad] or [m].
  double initial = 0;
  /// Maximum holding torque [N m] or force [N] of the joint's brake; 0 if it has no brake.
  double brake = 0;
  /// Limits of a ball joint's rotation [rad]; pi means no limit.
  double cone = kPi, twist = kPi;

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

/// Position of one joint at the start, from a machine file or from a scene that includes the
/// machine.
struct InitialPosition {
  std::string joint;
  /// Position of a revolute joint [rad].
  double angle = 0;
  /// Position of a prismatic joint [m].
  double length = 0;
  bool has_angle = false, has_length = false;

  void describe(Fields& f) {
    f.attribute("name", joint, "Joint of the machine.");
    f("initial_deg", angle, {-3600, 3600}, "Position of a revolute joint.", given(has_angle));
    f("initial_m", length, {-1000, 1000}, "Position of a prismatic joint.", given(has_length));
  }
};

/// A hydraulic cylinder that moves one joint, directly between two pins or through a four-bar
/// linkage. The geometry gives the cylinder's length and lever arm at each joint position. Oil
/// pressure acts on the areas of bore and rod, and the resulting force times the lever arm is the
/// joint torque [docs/machines.md, hydraulics]. The pump fills the head side to extend the
/// cylinder.
struct Cylinder {
  std::string name;
  std::string joint;
  std::string base_link, rod_link;
  Vec3 p_base = Vec3::Zero();
  Vec3 p_rod = Vec3::Zero();
  /// True if the rod turns a rocker whose coupler turns the bucket.
  bool has_linkage = false;
  Vec3 p_rocker = Vec3::Zero();
  double rocker_rod = 0, rocker_coupler = 0;
  double coupler = 0;
  Vec3 p_coupler = Vec3::Zero();
  int count = 1;
  double bore = 0.12, rod = 0.085;
  double pressure = 35e6;
  /// Distance between cylinders side by side [m]; for pictures only.
  double spacing = 0.68;
  double flow = 0.004;

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

/// The load-sensing pump that all cylinders of a machine share. If the valves demand more than the
/// pump's flow or power, all cylinders slow down in the same proportion [docs/machines.md, pump].
struct Pump {
  double flow = 0;
  double power = 0;

  void describe(Fields& f) {
    f("flow_m3_per_s", flow, {1e-7, 10}, "Greatest flow of oil.", kNeeded);
    f("power_w", power, {0.1, 1e7}, "Greatest flow x pressure.", kNeeded);
  }
};

/// Track of a crawler. It runs around a sprocket, an idler and the rollers between them, which
/// press its lower run onto the ground; the track does not stretch [docs/machines.md, tracks].
/// Positions are in the frame of the link that carries the track (the parent link of the sprocket's
/// joint), with x ahead and z up.
struct Track {
  Vec3 p_idler = Vec3::Zero();
  double idler_radius = 0.35;
  /// Centres of the rollers [m], sorted from front to rear.
  std::vector<Vec3> rollers;
  double roller_radius = 0.1;
  double thickness = 0.05;

  void describe(Fields& f) {
    f("idler_m", p_idler, "Middle of the idler.", kNeeded);
    f("idler_radius_m", idler_radius, {0.01, 5}, "Radius of the idler's rim.", kNeeded);
    f("roller_m", rollers, {-1e3, 1e3},
      "Middle of a roller between idler and sprocket; two or more, all at about one height.",
      kNeeded);
    f("roller_radius_m", roller_radius, {0.005, 5}, "Radius of a roller's rim.", kNeeded);
    f("thickness_m", thickness, {0, 1}, "Thickness of the track, from rim to ground.");
  }
  /// Returns the two ends of the track's lower run: the points on the ground below the first and
  /// the last roller [m], in the frame of the link that carries the track.
  std::array<Vec3, 2> lower_run() const {
    const Vec3 down(0, 0, -roller_radius - thickness);
    return {Vec3(rollers.front() + down), Vec3(rollers.back() + down)};
  }
};

/// A tyre (or a twin pair of tyres) with its own force law on the ground, or the sprocket of a
/// crawler's track. Pressure, slip and load determine a tyre's forces [docs/machines.md, tyres];
/// soil that it compacts permanently forms a rut [docs/machines.md, ruts].
struct Wheel {
  std::string joint;
  /// Joint that steers the wheel; empty if it is not steered.
  std::string steer_joint;
  bool driven = false;
  double radius = 0.525;
  double width = 0.28;
  /// Distance between the centres of twin tyres [m]; 0 for a single tyre.
  double twin_spacing = 0;
  double stiffness = 1.2e6;
  double damping = 1.5e4;
  double friction = 0.8;
  double rolling_resistance = 0.02;
  /// The track, if the wheel is a sprocket. `stiffness` and `damping` are then totals of all
  /// rollers.
  std::optional<Track> track;
  std::string name;

  /// Returns a sprocket with default values for a crawler of 18 t (U).
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

/// An incremental encoder on a rotating joint: a counter of a few bits that wraps around, as a
/// robot's controller reads it [docs/machines.md, encoders]. It can simulate measurement errors.
struct Encoder {
  std::string joint;
  double counts_per_turn = 4096;
  int bits = 16;
  double slip = 0;
  double missed = 0;

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

/// Two levers of an excavator operator, with the assignment of [ISO 10968] or the one of backhoes,
/// in which boom and stick are exchanged.
struct Levers {
  enum class Pattern { kIso, kSae };
  /// True if the machine's file contains the element.
  bool given = false;
  Pattern pattern = Pattern::kIso;
  double dead_band = 0.05;

  void describe(Fields& f) {
    f("pattern", pattern, {{"iso", Pattern::kIso}, {"sae", Pattern::kSae}},
      "Assignment of the levers to the joints.");
    f("dead_band", dead_band, {0, 0.5},
      "Share of a lever's travel on either side of the middle that opens no valve.");
  }
};

/// A thin shell of triangles, in the link frame [m], that touches soil: a bucket, blade, plate or
/// bed. It has two sides and a thickness, and it may be open. The front of the triangles is the
/// inside; soil on the front is inside the shell. Edges that belong to one triangle only are free
/// edges [docs/tools.md, shells].
struct Shell : geometry::TriangleMesh {
  std::string name;
  std::string link;
  double half_thickness = 0.015;
  double friction_share = 1, adhesion_share = 1;
  std::string mesh;
  /// Vertex coordinates and corner indices as written in the file; empty after the triangles were
  /// built.
  std::vector<double> vertex_numbers, corner_numbers;

  void describe(Fields& f) {
    f.attribute("name", name, "Name of the shell.", kNeeded);
    f("link", link, Refers::kLink, "Link that carries the shell.", kNeeded);
    f("mesh", mesh, "OBJ file of the surface; of a bucket best the middle surface of its plates.",
      kShown);
    f("vertices_m", vertex_numbers, {-1000, 1000}, "Vertices x y z, instead of a mesh.", kShown);
    f("triangles", corner_numbers, {0, 1e6},
      "Three numbers of vertices, from 0, per triangle; counter-clockwise as seen from the inside "
      "of a bucket, or from outside of a closed body.",
      kShown);
    f.derived_text("surface", [this] { return surface_hash(); });
    f("half_thickness_m", half_thickness, {1e-4, 1}, "Half the thickness of the plate.");
    f("friction_share", friction_share, {0, 2},
      "Share of the tangent of a soil's tool friction angle; 0 with adhesion_share 0: smooth.");
    f("adhesion_share", adhesion_share, {0, 2}, "Share of a soil's adhesion.");
  }

 private:
  /// Returns a hash of all vertices and triangles, as a hexadecimal number.
  std::string surface_hash() const;
};

/// Marks a link as a digging bucket. Operators use these values to position the cutting edge; the
/// soil interacts with the shell only.
struct Bucket {
  std::string link;
  std::string shell;
  double capacity = 0.8;
  double width = 1.05;
  Vec3 p_tip = Vec3::Zero();
  Vec3 cut_direction = Vec3::UnitX();
  Vec3 opening = Vec3::UnitZ();
  std::string name;

  void describe(Fields& f) {
    f.attribute("name", name, "Name of the bucket, for the reader of the file.", kShown);
    f("link", link, Refers::kLink, "Link of the bucket.", kNeeded);
    f("shell", shell, Refers::kShell, "Shell of the bucket.", kNeeded);
    f("capacity_m3", capacity, {1e-4, 100}, "Heaped capacity.");
    f("width_m", width, {0.01, 20}, "Width of the cut.");
    f("tip_m", p_tip, "Middle of the cutting edge in the frame of the link.", kNeeded);
    f("cut_direction", Direction{&cut_direction},
      "Direction of the edge, along the floor and outward.");
    f("opening", Direction{&opening}, "Direction out of the mouth.");
  }
};

/// Marks a link as a container that can tip out its load, such as a dumper's bed or a skip. A
/// machine has at most one.
struct Bed {
  std::string link;
  std::string shell;
  std::string joint;
  double capacity = 3.0;
  std::string name;

  void describe(Fields& f) {
    f.attribute("name", name, "Name of the bed, for the reader of the file.", kShown);
    f("link", link, Refers::kLink, "Link of the bed.", kNeeded);
    f("shell", shell, Refers::kShell, "Shell of the bed, on the same link.", kNeeded);
    f("joint", joint, Refers::kJoint, "Revolute joint that tips the bed.", kNeeded);
    f("capacity_m3", capacity, {1e-4, 1000}, "Struck capacity, level with the rim.");
  }
};

/// Names of the joints of an excavator's arm, by their function. A name is empty if the machine has
/// no such joint.
struct Arm {
  std::string swing, boom, stick, bucket;

  void describe(Fields& f) {
    f("swing_joint", swing, Refers::kJoint, "Upper structure about the chassis.");
    f("boom_joint", boom, Refers::kJoint, "Boom about the upper structure.");
    f("stick_joint", stick, Refers::kJoint, "Stick about the boom.");
    f("bucket_joint", bucket, Refers::kJoint, "Bucket about the stick.");
  }
};

/// Limits of the ground that a machine can drive on (U). Maps and path planning use them.
struct Traversability {
  /// True if the machine's file contains the element.
  bool given = false;
  double slope = radians(30);
  double step_height = 0.30, roughness = 0.10;
  double window = 0.20;

  void describe(Fields& f) {
    f("slope_deg", slope, {1, 89}, "Steepest slope.");
    f("step_m", step_height, {0.001, 100}, "Highest step within the window.");
    f("roughness_m", roughness, {0.001, 100}, "Greatest rms deviation from a plane in the window.");
    f("window_m", window, {0.01, 10}, "Half the side of the square window.");
  }
};

/// A machine as one SDF file describes it. (MachineInWorld adds its pose and program.) Index
/// members refer to the vectors of the same machine and become invalid if elements are inserted.
struct Machine {
  std::string name;
  /// Path of the SDF file.
  std::string file;
  /// True if joint positions are prescribed and no dynamics are computed.
  bool kinematic = false;
  bool fixed_base = false;
  /// Links of the machine; links[0] is the base.
  std::vector<Link> links;
  std::vector<Joint> joints;
  std::vector<Cylinder> cylinders;
  /// False if each cylinder has its own flow.
  bool has_pump = false;
  Pump pump;
  std::vector<Wheel> wheels;
  /// False if the wheels turn freely or by joint commands.
  bool has_drive = false;
  Drive drive;
  std::vector<Shell> shells;
  std::vector<Bucket> buckets;
  std::vector<Bed> beds;
  Arm arm;
  Traversability traversability;
  /// Encoders, at most one per joint.
  std::vector<Encoder> encoders;
  Levers levers;
  bool derive_collisions = true;
  std::vector<InitialPosition> initial_positions;
  /// Messages about properties that the loader derived: collision shapes from visuals, masses from
  /// densities.
  std::vector<std::string> derived;

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

  /// Returns the index of the link or joint with this name; -1 if there is none. The search is
  /// linear.
  int link_index(const std::string& name_of_link) const;
  int joint_index(const std::string& name_of_joint) const;
  /// Returns true if the shell with this index belongs to a bucket (soil in it is dug) or to a bed
  /// (soil in it is carried).
  bool is_bucket(int shell) const;
  bool is_bed(int shell) const;
};

}  // namespace navvy::scene
