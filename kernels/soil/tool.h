// SPDX-License-Identifier: Apache-2.0
// Structs of tools and of the contact with them, shared by host and kernels. They contain only
// scalars and arrays of scalars.
//
// The coordinates of a tool are relative to its window corner: the lower corner of the block that
// contains the origin of the tool's frame. Floats are then equally precise a kilometre from the
// site's origin. Lengths are in cells; directions are along the axes of W.
#ifndef NAVVY_KERNELS_SOIL_TOOL_H
#define NAVVY_KERNELS_SOIL_TOOL_H

// Parameters of the contact; lengths are in cells.
//
// h: clearance from the plate's face at which a node gets half of the contact share
//
// ramp: length over which that share falls from 1 to 0
//
// edge, edge_ramp: the same two lengths along the plate, measured from a free edge
//
// patch: area of a cell's face x dt [m2 s]
//
// opening: separation speed above which adhesion has ended [m/s]
//
// settling: speed at which soil at the end of the reach settles towards a plate that does not
// advance [m/s]
//
// falling: speed at which a plate falls onto soil through nodes that carry almost no load [m/s]
//
// slow: speed below which a plate counts as standing still, for the resistance of its edges [m/s]
//
// down_x, down_y, down_z: unit vector of gravity in W; zero without gravity
#define REACH_FIELDS(X) \
  X(h)                  \
  X(ramp)               \
  X(edge)               \
  X(edge_ramp)          \
  X(patch)              \
  X(opening)            \
  X(settling)           \
  X(falling)            \
  X(slow)               \
  X(down_x)             \
  X(down_y)             \
  X(down_z)

#ifdef __cplusplus
#include <cstddef>
namespace navvy::soil {

/// The parameters of REACH_FIELDS as a kernel argument. contact_law.h defines the same struct in
/// the precision of its arithmetic (Reach).
#define REACH_FLOAT(name) float name;
struct ContactReach {
  REACH_FIELDS(REACH_FLOAT)
};
#undef REACH_FLOAT
#endif

// One tool in the current step.
typedef struct Tool {
  // Block whose lower corner is the origin of the tool's coordinates.
  int window[3];
  // 1 if the tool takes part in this step, else 0.
  int active;
  // Origin of the tool's frame, relative to the window corner [cells].
  float origin[3];
  // Half the thickness of the tool's plates [cells].
  float half_thickness;
  // Current twist: angular velocity [rad/s], then velocity of the tool's origin [m/s]. The contact
  // solve changes it.
  float twist[6];
  // Twist before the soil acts in this step.
  float start[6];
  // Change of the twist per unit of impulse (angular impulse about the origin, then impulse), row
  // by row. Zero for a scripted tool, which does not yield.
  float inverse_mass[36];
  // Factor on the friction coefficient between soil and tool.
  float friction;
  // Factor on the soil's adhesion. It includes plate area / sum of the areas that the tool's nodes
  // represent.
  float adhesion;
} Tool;

// A face, edge or corner of a shell.
typedef struct ShellFeature {
  // Pseudo-normal, which separates front and back for points closest to this feature.
  float normal[3];
  // 1 if the feature is on a free edge, where the plate ends; else 0.
  float free;
} ShellFeature;

// One triangle of a tool's shell, with corners a, b, c relative to the tool's window corner
// [cells].
typedef struct ShellTriangle {
  // Corner a.
  float a[3];
  // Index of the tool.
  int tool;
  // Corner b.
  float b[3];
  // Distance from the triangle's centre to its farthest corner [cells].
  float radius;
  // Corner c.
  float c[3];
  // Padding to 16 bytes.
  float unused;
  // Features: [0] the face; [1] .. [3] the edges ab, bc, ca; [4] .. [6] the corners a, b, c.
  ShellFeature feature[7];
} ShellTriangle;

// One free edge of a shell, relative to the tool's window corner [cells].
typedef struct ShellRim {
  // Start point of the edge.
  float start[3];
  // Index of the tool.
  int tool;
  // Vector from the start point to the end point.
  float along[3];
  // Padding to 16 bytes.
  float unused;
} ShellRim;

// Position of a near node relative to the closest plate.
typedef struct NodeShell {
  // Unit normal of the plate at the closest point, towards its front.
  float normal[3];
  // Distance from the middle surface of the plate, positive in front [cells].
  float distance;
  // Distance along the plate to its nearest free edge [cells]; infinite without free edges.
  float inset;
  // Padding to 32 bytes.
  float unused[3];
} NodeShell;

// Number of friction angles in an EdgeProfile: sin phi = i EDGE_STEP, i = 0 .. EDGE_ANGLES - 1. The
// last one is 53 deg, above any soil.
#define EDGE_ANGLES 65
#define EDGE_STEP 0.0125f

// Bearing factors of an edge at one friction angle of the soil [docs/tools.md, edges].
typedef struct EdgeFactors {
  // Factors of cohesion and of overburden for a blunt edge.
  float flat_c, flat_q;
  // The same for a smooth wedge with the edge's bevel.
  float wedge_c, wedge_q;
} EdgeFactors;

// Shape of the edges of a tool.
typedef struct EdgeProfile {
  // Factors at sin phi = i EDGE_STEP.
  EdgeFactors at[EDGE_ANGLES];
  // 1 / tangent of half the bevel; 0 for a blunt edge.
  float cot;
  // Padding to 16 bytes.
  float unused[3];
} EdgeProfile;

// Part of the edges of a tool that a near node stands for.
typedef struct NodeEdge {
  // Outward direction of the plate, times the area of its end that the node stands for [cell
  // faces].
  float outward[3];
  // 0 without an edge; else 1 + tool index + (profile index << 16).
  int tag;
} NodeEdge;

// One velocity field of a near node that a tool may act on: everything that its impulse depends on
// except the tool's twist. contact_law.h describes most members (ContactNode).
typedef struct NodeContact {
  // Velocity before contact [m/s].
  float v[3];
  // Mass [kg].
  float m;
  // Lever arm from the tool's origin [m].
  float r[3];
  float share;
  // Unit normal from the plate towards the node.
  float n[3];
  float settling;
  float mu, stick, edge;
  // CONTACT_PLACE of the field.
  int place;
} NodeContact;

// Largest number of contacts of a near block: both fields of all its nodes.
#define BLOCK_CONTACTS 128
// Packs the place of a contact: field s (0 front, 1 back) of node n (0 .. 63) in its block, near
// tool `tool`; edge: 1 if the node is ahead of an edge of a plate, 0 if it is beside a face.
#define CONTACT_PLACE(s, n, edge, tool) ((s) | (n) << 1 | (edge) << 7 | (tool) << 8)
#define CONTACT_FIELD(place) ((place)&1)
#define CONTACT_NODE(place) ((place) >> 1 & 63)
#define CONTACT_EDGE(place) ((place) >> 7 & 1)
#define CONTACT_TOOL(place) ((place) >> 8)

// Change of one velocity field of a node by contact.
typedef struct ContactRecord {
  // Velocity before contact [m/s].
  float before[3];
  // Mass of the field [kg].
  float mass;
  // Velocity after contact, before the hold of the resting ground [m/s]; that before contact where
  // the tool did not act.
  float after[3];
  // Normal impulse on the node [N s].
  float push;
  // CONTACT_PLACE of the field.
  int place;
} ContactRecord;

// Number of words of ContactSums, which kernels add word by word.
#define CONTACT_SUM_WORDS 28
// Sums over contacts, for the solve of a tool's twist.
typedef struct ContactSums {
  // Impulse on the soil: moment about the tool's origin [N m s], then impulse [N s].
  float wrench[6];
  // Derivative of the wrench with respect to the tool's twist: upper triangle of the symmetric 6 x
  // 6 matrix, row by row.
  float stiffness[21];
  // Padding, so that the struct has 28 words.
  float unused;
} ContactSums;

#ifdef __cplusplus
static_assert(sizeof(ContactReach) == 48);
static_assert(sizeof(Tool) == 232 && offsetof(Tool, origin) == 16 && offsetof(Tool, twist) == 32 &&
              offsetof(Tool, inverse_mass) == 80 && offsetof(Tool, adhesion) == 228);
static_assert(sizeof(ShellFeature) == 16 && sizeof(ShellTriangle) == 160 &&
              offsetof(ShellTriangle, feature) == 48);
static_assert(sizeof(ShellRim) == 32 && offsetof(ShellRim, along) == 16);
static_assert(sizeof(NodeShell) == 32 && offsetof(NodeShell, inset) == 16);
static_assert(sizeof(EdgeProfile) == 16 * (EDGE_ANGLES + 1) && sizeof(NodeEdge) == 16);
static_assert(sizeof(NodeContact) == 64 && offsetof(NodeContact, place) == 60);
static_assert(sizeof(ContactRecord) == 36 && offsetof(ContactRecord, after) == 16);
static_assert(sizeof(ContactSums) == 4 * CONTACT_SUM_WORDS);
}  // namespace navvy::soil
#endif

#endif  // NAVVY_KERNELS_SOIL_TOOL_H
