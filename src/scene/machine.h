// SPDX-License-Identifier: Apache-2.0
// A machine as data: links, joints, hydraulics, drive train, tyres and the shells that touch soil.
// Frames: M machine (x forward, y left, z up, origin as its SDF says), L link, J joint. All values
// are in SI units, angles in radians; `describe` documents what a file gives.
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

/// A shape about its own origin, lengths in metres. A kind ignores the members it does not use.
struct Geometry {
  enum class Kind { kBox, kCylinder, kSphere, kMesh, kPlane, kCone, kCapsule };
  Kind kind = Kind::kBox;
  Vec3 size = Vec3::Ones();   ///< edges of a box; x and y of a plane
  double radius = 0.5;        ///< of a cylinder, capsule (axis z) or sphere, or a cone's foot
  double length = 1.0;        ///< of a cylinder or cone (tip at +z); of a capsule without its caps
  std::string mesh_file;      ///< absolute path of an OBJ file
  Vec3 scale = Vec3::Ones();  ///< factors along the axes of a mesh file

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

/// Documentation and range of the density that links and shapes may have.
inline void describe_density(Fields& f, double& density) {
  f("navvy:density_kg_per_m3", density, {1, 25000},
    "Density of the link or shape, from which mass, centre and inertia follow without <inertial>. "
    "Collision shapes count, visuals where there are none; each is solid and counted whole.",
    kShown);
}

/// Appearance of a link. V is the frame of the visual.
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

/// Contact shape of a link against rigid bodies. Soil touches shells instead, so a bucket has both.
struct Collision {
  std::string name;
  Geometry geometry;
  Pose X_LC = Pose::Identity();
  double friction = 0.8;  ///< Coulomb coefficient [-]; the physics engine combines those of a pair
  bool derived = false;   ///< made from a visual, as the machine's file gave no collision
  double density = 0;     ///< [kg/m3]; 0: not given

  void describe(Fields& f) {
    f.attribute("name", name, "Name of the collision.");
    describe_density(f, density);
    geometry.describe(f);
    f.derived("pose", X_LC);
    f.derived("friction", friction);
  }
};

/// A rigid body of a machine. `p_LCom` is a point of L; the inertia is about that point, in L's
/// axes.
struct Link {
  std::string name;
  Pose X_ML = Pose::Identity();     ///< at zero joint positions
  double mass = 1;                  ///< [kg]
  Vec3 p_LCom = Vec3::Zero();       ///< centre of mass [m]
  Mat3 inertia = Mat3::Identity();  ///< [kg m2]
  std::vector<Visual> visuals;
  std::vector<Collision> collisions;
  LinkMaterial material;  ///< of its collisions and shells against bodies
  double density = 0;     ///< [kg/m3]; 0: not given

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

/// A joint between two links. A positive position is about or along `axis` by the right hand.
struct Joint {
  enum class Type { kFixed, kRevolute, kPrismatic, kBall };
  std::string name;
  Type type = Type::kFixed;
  int parent = -1;  ///< index into Machine::links; -1: world
  int child = -1;
  Pose X_LcJ = Pose::Identity();   ///< joint frame in the child link
  Vec3 axis = Vec3::UnitZ();       ///< unit, in the joint frame at zero position
  bool has_limits = false;         ///< false: continuous
  double lower = 0, upper = 0;     ///< [rad] or [m]
  double effort = 1e9;             ///< [N m] or [N]; hydraulics may limit further
  double velocity = 1e9;           ///< [rad/s] or [m/s]
  double damping = 0;              ///< [N m s/rad] or [N s/m]
  double friction = 0;             ///< dry friction [N m] or [N]
  double initial = 0;              ///< position at the start [rad] or [m]
  double brake = 0;                ///< holding torque [N m] or force [N]; 0: no brake
  double cone = kPi, twist = kPi;  ///< limits of a ball joint [rad]; pi: free

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

/// Position of a joint at the start, from a file or from a scene that includes it.
struct InitialPosition {
  std::string joint;
  double angle = 0;   ///< [rad]
  double length = 0;  ///< [m]
  bool has_angle = false, has_length = false;

  void describe(Fields& f) {
    f.attribute("name", joint, "Joint of the machine.");
    f("initial_deg", angle, {-3600, 3600}, "Position of a revolute joint.", given(has_angle));
    f("initial_m", length, {-1000, 1000}, "Position of a prismatic joint.", given(has_length));
  }
};

/// A hydraulic cylinder acting on one joint. Its length and lever arm follow from two pins, or from
/// a four-bar linkage. The pump fills the head side when the cylinder extends. Pressures become
/// forces by bore and rod, forces become joint torques by the lever arm at each position
/// [docs/machines.md, hydraulics].
struct Cylinder {
  std::string name;
  std::string joint;
  std::string base_link, rod_link;
  Vec3 p_base = Vec3::Zero();
  Vec3 p_rod = Vec3::Zero();
  bool has_linkage = false;  ///< the rod turns a rocker, whose coupler turns the bucket
  Vec3 p_rocker = Vec3::Zero();
  double rocker_rod = 0, rocker_coupler = 0;
  double coupler = 0;
  Vec3 p_coupler = Vec3::Zero();
  int count = 1;
  double bore = 0.12, rod = 0.085;
  double pressure = 35e6;
  double spacing = 0.68;  ///< between the middles of cylinders side by side, for pictures [m]
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

/// The load-sensing pump that all cylinders of a machine share. If the valves ask for more than its
/// flow or power, all of them slow down by the same share [docs/machines.md, pump].
struct Pump {
  double flow = 0;
  double power = 0;

  void describe(Fields& f) {
    f("flow_m3_per_s", flow, {1e-7, 10}, "Greatest flow of oil.", kNeeded);
    f("power_w", power, {0.1, 1e7}, "Greatest flow x pressure.", kNeeded);
  }
};

/// Track of a crawler. It runs round a sprocket, an idler and the rollers between them, which press
/// its lower run on the ground; it does not stretch [docs/machines.md, tracks]. Points are in the
/// frame of the link that carries it, the parent of the sprocket's joint, x ahead and z up.
struct Track {
  Vec3 p_idler = Vec3::Zero();
  double idler_radius = 0.35;
  std::vector<Vec3> rollers;  ///< from the foremost to the last
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
  /// Returns the ends of the lower run: on the ground under the first and the last roller [m].
  std::array<Vec3, 2> lower_run() const {
    const Vec3 down(0, 0, -roller_radius - thickness);
    return {Vec3(rollers.front() + down), Vec3(rollers.back() + down)};
  }
};

/// A tyre (or a twin pair as one) with its own force law on the ground, or the sprocket of a track.
/// Its forces follow from pressure, slip and load [docs/machines.md, tyres]; soil that it compacts
/// for good is a rut [docs/machines.md, ruts].
struct Wheel {
  std::string joint;
  std::string steer_joint;  ///< empty: not steered
  bool driven = false;
  double radius = 0.525;
  double width = 0.28;
  double twin_spacing = 0;  ///< 0: single tyre
  double stiffness = 1.2e6;
  double damping = 1.5e4;
  double friction = 0.8;
  double rolling_resistance = 0.02;
  /// Track of a sprocket; stiffness and damping are then those of all rollers together.
  std::optional<Track> track;
  std::string name;

  /// Returns a sprocket with the default values of a machine of 18 t (U).
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

/// An incremental encoder on a joint that turns: a counter of a few bits that wraps, as a robot
/// hands it to its controller [docs/machines.md, encoders]. It can simulate faults.
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

/// The two levers of an excavator's operator, [ISO 10968] or the pattern of backhoes with boom and
/// stick exchanged.
struct Levers {
  enum class Pattern { kIso, kSae };
  bool given = false;  ///< by the machine's file
  Pattern pattern = Pattern::kIso;
  double dead_band = 0.05;

  void describe(Fields& f) {
    f("pattern", pattern, {{"iso", Pattern::kIso}, {"sae", Pattern::kSae}},
      "Assignment of the levers to the joints.");
    f("dead_band", dead_band, {0, 0.5},
      "Share of a lever's travel on either side of the middle that opens no valve.");
  }
};

/// A thin shell of triangles, in the link frame [m], that touches soil: a bucket, blade, plate,
/// bed. The front of the triangles is the inside. Edges of one triangle only are free edges. A
/// shell has two sides and a thickness and may be open: it holds the soil on its front
/// [docs/tools.md, shells].
struct Shell : geometry::TriangleMesh {
  std::string name;
  std::string link;
  double half_thickness = 0.015;
  double friction_share = 1, adhesion_share = 1;
  std::string mesh;
  std::vector<double> vertex_numbers, corner_numbers;  ///< as read; empty afterwards

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
  /// Returns one number for thousands of vertices.
  std::string surface_hash() const;
};

/// Makes a link a digging bucket. Operators use it to aim the edge; soil sees only the shell.
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

/// Makes a link a container that tips its load: a dumper's bed, a skip. One per machine.
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

/// Joints of an excavator's arm by their roles; empty where the machine has none.
struct Arm {
  std::string swing, boom, stick, bucket;

  void describe(Fields& f) {
    f("swing_joint", swing, Refers::kJoint, "Upper structure about the chassis.");
    f("boom_joint", boom, Refers::kJoint, "Boom about the upper structure.");
    f("stick_joint", stick, Refers::kJoint, "Stick about the boom.");
    f("bucket_joint", bucket, Refers::kJoint, "Bucket about the stick.");
  }
};

/// Limits of the ground that a machine can drive on, for maps and planned paths (U).
struct Traversability {
  bool given = false;  ///< by the machine's file
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

/// A machine as one SDF file describes it; MachineInWorld holds its place and task. Indices refer
/// to the lists here and are valid until something is inserted.
struct Machine {
  std::string name;
  std::string file;        ///< SDF file it came from
  bool kinematic = false;  ///< moved by joint positions only, no dynamics
  bool fixed_base = false;
  // Every parent comes before its children, and joint i moves link i + 1.
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
  std::vector<Encoder> encoders;  ///< one per joint at most
  Levers levers;
  bool derive_collisions = true;
  std::vector<InitialPosition> initial_positions;
  /// Sentences about collision shapes from visuals and masses from densities.
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

  /// Returns an index by name, -1 if there is none. The search is linear.
  int link_index(const std::string& name_of_link) const;
  int joint_index(const std::string& name_of_joint) const;
  /// Returns true if a shell, by its index, holds soil that is dug (bucket) or carried (bed).
  bool is_bucket(int shell) const;
  bool is_bed(int shell) const;
};

}  // namespace navvy::scene
