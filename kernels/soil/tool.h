// SPDX-License-Identifier: Apache-2.0
// What the kernels know of tools, and what they tell of the contact with them: structs of host and
// device. Scalars and arrays of scalars only.
//
// Coordinates of a tool count from the corner of its window, the block its origin lies in: floats
// stay as fine a kilometre from the site's origin. Lengths in cells, directions along the axes of
// W.
#ifndef NAVVY_KERNELS_SOIL_TOOL_H
#define NAVVY_KERNELS_SOIL_TOOL_H

// Reach of a contact. h: nodes closer than this to the plate's face act; ramp: over which their
// share falls to zero; edge: nodes closer than this to a free edge do not act; edge_ramp: over
// which their share falls along the plate [all cells]; patch: face of a cell x dt [m2 s]; opening:
// soil that leaves the plate faster has let go [m/s]; settling: speed at the end of the reach at
// which soil comes nearer to a plate that does not advance [m/s]; falling: speed at which a plate
// falls onto soil through nodes that hardly bear [m/s]; down_x, down_y, down_z: unit vector of
// gravity, or none.
#define REACH_FIELDS(X) \
  X(h)                  \
  X(ramp)               \
  X(edge)               \
  X(edge_ramp)          \
  X(patch)              \
  X(opening)            \
  X(settling)           \
  X(falling)            \
  X(down_x)             \
  X(down_y)             \
  X(down_z)

#ifdef __cplusplus
#include <cstddef>
namespace navvy::soil {

/// REACH_FIELDS as the kernels take them; what computes with them (contact_law.h) has them in its
/// own precision.
#define REACH_FLOAT(name) float name;
struct ContactReach {
  REACH_FIELDS(REACH_FLOAT)
};
#undef REACH_FLOAT
#endif

// One tool in this step.
typedef struct Tool {
  int window[3];           // block from whose corner its coordinates count
  int active;              // 1 when the tool moves or stands in this step
  float origin[3];         // of the tool's frame, from the window's corner [cells]
  float half_thickness;    // of its plates [cells]
  // Angular velocity [rad/s], velocity of the origin [m/s]; the two-way solve changes it
  float twist[6];
  float start[6];          // twist before soil acts
  // Change of twist per impulse (moment about the origin, impulse), row major; 0: scripted
  float inverse_mass[36];
  float friction;          // share of the soil's tool friction (its tangent) that this tool has
  // Share of the soil's adhesion, times plate area / sum of the areas its nodes stand for
  float adhesion;
} Tool;

// A direction that tells the front from the back of the closest point, and whether the plate ends
// there.
typedef struct ShellFeature {
  float normal[3];
  float free;  // 1 on a free edge
} ShellFeature;

// One triangle of a tool's shell. The face is feature 0, the edges ab bc ca are 1..3, the corners a
// b c 4..6.
typedef struct ShellTriangle {
  float a[3];
  int tool;
  float b[3];
  float radius;  // distance of the farthest corner from the centre
  float c[3];
  float unused;
  ShellFeature feature[7];
} ShellTriangle;

// A free edge.
typedef struct ShellRim {
  float start[3];
  int tool;
  float along[3];
  float unused;
} ShellRim;

// Where a node near a shell lies.
typedef struct NodeShell {
  float normal[3];  // towards the node's side when it is the front
  float distance;   // from the plate's middle, positive in front [cells]
  float inset;      // distance along the plate to its free edge [cells]
  float unused[3];
} NodeShell;

// What contact did to one field of a node.
typedef struct ContactRecord {
  float before[3];  // velocity before contact [m/s]
  float mass;       // [kg]
  float after[3];   // after contact and before the floor [m/s]
  float push;       // normal impulse [N s]
} ContactRecord;

// Sums over the nodes of a near block in the two-way solve, added up word by word.
#define CONTACT_SUM_WORDS 28
typedef struct ContactSums {
  float wrench[6];      // moment about the tool's origin [N m s], impulse [N s]
  float stiffness[21];  // upper triangle of its slope against the twist, row by row
  float unused;
} ContactSums;

#ifdef __cplusplus
static_assert(sizeof(ContactReach) == 44);
static_assert(sizeof(Tool) == 232 && offsetof(Tool, origin) == 16 && offsetof(Tool, twist) == 32 &&
              offsetof(Tool, inverse_mass) == 80 && offsetof(Tool, adhesion) == 228);
static_assert(sizeof(ShellFeature) == 16 && sizeof(ShellTriangle) == 160 && offsetof(ShellTriangle, feature) == 48);
static_assert(sizeof(ShellRim) == 32 && offsetof(ShellRim, along) == 16);
static_assert(sizeof(NodeShell) == 32 && offsetof(NodeShell, inset) == 16);
static_assert(sizeof(ContactRecord) == 32 && offsetof(ContactRecord, after) == 16);
static_assert(sizeof(ContactSums) == 4 * CONTACT_SUM_WORDS);
}  // namespace navvy::soil
#endif

#endif  // NAVVY_KERNELS_SOIL_TOOL_H
