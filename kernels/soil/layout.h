// SPDX-License-Identifier: Apache-2.0
// Layout of the particle and grid arrays, read by the host and by the kernels. Scalars and macros only.
//
// Particles are stored by home block, each block's run starting at a multiple of NAVVY_LANES; lanes past a block's count
// have mass 0. Field f of slot i is word f * capacity + i. A particle's home is the block of its base node
// floor(x - 0.5), so x runs over [0.5, 4.5) after a re-bin and may drift one cell to each side before the next one.
// A tile is the 8 x 8 x 8 nodes -1..6 of a home block, x fastest, one float4 each.
#ifndef NAVVY_KERNELS_SOIL_LAYOUT_H
#define NAVVY_KERNELS_SOIL_LAYOUT_H

#define NAVVY_LANES 16

#define FIELD_X 0       // 3: offset from the home block's corner [cells]
#define FIELD_V 3       // 3: [m/s]
#define FIELD_C 6       // 9: velocity gradient, row major [1/s]
#define FIELD_S 15      // 6: deviatoric stress xx yy zz xy yz xz [Pa]
#define FIELD_J 21      // volume ratio
#define FIELD_J0 22     // density state
#define FIELD_SHEAR 23  // plastic shear
#define FIELD_MASS 24   // int, mass quanta
#define FIELD_TAG 25    // int, soil | side << 16
#define FIELD_ID 26     // int
#define FIELD_COUNT 27

#define MASS_QUANTUM (1.0f / 16777216.0f)  // core/math.h kMassQuantum [kg]; a lighter node is empty

#define TILE_NODES 516  // 512 and a pad row end: a float16 read of the last row stays inside; not a power of two
#define BLOCK_NODES 64

// Resting ground of one active block [cells from its corner]: for its 16 node columns, x fastest, the height up to which
// nodes are held; then for each the heights of the four columns around it.
#define FLOOR_COLUMNS 16
#define FLOOR_WORDS 80

// Densest state that soil is pressed into, and that columns take from particles [evidence, section 4: a tighter clamp
// creates volume].
#define DENSEST_STATE 0.88

// One soil in the constant table.
#define SOIL_BULK 0
#define SOIL_SHEAR 1
#define SOIL_ALPHA 2
#define SOIL_K_RESIDUAL 3
#define SOIL_K_BOND 4
#define SOIL_INV_REMOULD 5
#define SOIL_INV_OPENING 6
#define SOIL_VISCOSITY 7
#define SOIL_SWELL 8
#define SOIL_LOOSENING 9
#define SOIL_INV_DENSITY 10
#define SOIL_LAW_WORDS 11  // the law needs those above
#define SOIL_DILATANCY 11
#define SOIL_INV_RANGE 12
#define SOIL_MATCHED 13
#define SOIL_ALPHA_FAST 14
#define SOIL_GRAIN 15
#define SOIL_INERTIAL 16
#define SOIL_CAP 17
#define SOIL_CAP_GROWTH 18
#define SOIL_EXTENDED_WORDS 19  // with LAW_EXTENDED it needs these, too
#define SOIL_TOOL_FRICTION 19
#define SOIL_ADHESION 20  // [Pa]
#define SOIL_WORDS 24

// The frame: what changes every step about the tools, one buffer of float4. Triangles first, SHELL_WORDS each (see
// shell_query.h), then the free edges, two each, then the tools from float4 number `first_tool` on, TOOL_WORDS floats:
#define TOOL_WINDOW 0   // 3 ints: block from whose corner the tool's float coordinates count
#define TOOL_ORIGIN 4   // 3: origin of the tool's frame [cells]
#define TOOL_HALF 7     // half thickness [cells]
#define TOOL_SPIN 8     // 3: angular velocity, axes of W [rad/s]; the two-way solve changes it
#define TOOL_ACTIVE 11  // 1 when the tool moves or stands in this step
#define TOOL_SPEED 12   // 3: velocity of the origin [m/s]; the two-way solve changes it
#define TOOL_START 16   // 6: twist before soil acts
#define TOOL_YIELD 22   // 36: inverse mass, row major, angular first
#define TOOL_FRICTION 58  // share of the soil's tool friction (its tangent) that this tool has
#define TOOL_ADHESION 59  // share of the soil's adhesion, times plate area / sum of the areas its nodes stand for
#define TOOL_WORDS 60

// Report of one home block after a step: 1 when a value was not finite, fastest velocity component [m/s], farthest push
// out of a plate [cells], particles on the wrong side of a shell.
#define REPORT_BAD 0
#define REPORT_SPEED 1
#define REPORT_PUSH 2
#define REPORT_CROSSED 3
#define REPORT_WORDS 4

// Sums of one near block in the two-way solve: 6 wrench, 21 upper triangle of the stiffness, 1 unused.
#define CONTACT_SUMS 28

// float4 words of one triangle, see shell_query.h.
#define SHELL_WORDS 10

#endif  // NAVVY_KERNELS_SOIL_LAYOUT_H
