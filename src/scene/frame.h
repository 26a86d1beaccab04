// SPDX-License-Identifier: Apache-2.0
// Input of renderers and cameras at one instant: shapes with poses, the ground and loose particles.
// The structs do not depend on a solver: the module sim fills them, the module render draws them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/math.h"
#include "scene/machine.h"
#include "scene/scene.h"

namespace navvy::scene {

/// A visual and its pose. V is the frame of the visual, W the world.
struct FrameShape {
  const Visual* visual = nullptr;  ///< appearance; must outlive the frame
  Pose X_WV = Pose::Identity();    ///< pose of the visual in W
};

/// A hydraulic cylinder, drawn as a round barrel that starts at the base pin and a thinner rod over
/// the whole distance between the pins.
struct FrameCylinder {
  /// Positions of the base pin and the rod pin in W [m].
  Vec3 p_base = Vec3::Zero(), p_rod = Vec3::Zero();
  double radius = 0.06;  ///< outer radius of the barrel [m]
  /// Length of the barrel [m]; may exceed the distance between the pins.
  double barrel_length = 0.5;
};

/// Half-open rectangle of columns of a FrameGround: x0 <= ix < x1 and y0 <= iy < y1.
struct FrameRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// Copy of the ground's surface. Arrays have one entry per column; that of column (ix, iy) is at
/// index ix + nx * iy. The entry applies to the centre of the column, origin + ((ix, iy) + 0.5) *
/// cell.
struct FrameGround {
  int nx = 0, ny = 0;          ///< numbers of columns along x and y
  double cell = 0.1;           ///< edge of a column [m]
  Vec2 origin = Vec2::Zero();  ///< lower-left corner of column (0,0) in W [m]
  std::vector<float> height;   ///< height of the surface in W [m]
  /// Height of the surface with the active soil that rests on it in W [m]; empty: `height`.
  std::vector<float> top;
  /// Height minus height at the start of the run [m]: negative where soil was dug.
  std::vector<float> change;
  std::vector<std::uint8_t> soil;  ///< index into `soil_color` of the soil at the surface
  /// Linear RGB color of each soil, by soil index; used for ground and particles.
  std::vector<Color> soil_color;
  /// 1 for each soil, by soil index, that is moist and darker where it is freshly dug. Empty: all.
  std::vector<std::uint8_t> soil_moist;
  /// Scale of the color by cut and fill [m]: soil is drawn in full color where `change` has this
  /// magnitude. 0: soil has its own color.
  double cut_fill = 0;
  std::uint64_t revision = 0;  ///< counter that changes whenever any height has changed
  /// Rectangles that contain every height change since the previous revision; they may overlap.
  std::vector<FrameRect> changed;
};

/// Loose soil: arrays with one entry per particle. Positions are floats relative to `origin`, so
/// that they remain precise on a large site.
struct FrameParticles {
  /// x, y, z of each particle relative to `origin`, in the axes of W [m]
  std::vector<float> position;
  Vec3 origin = Vec3::Zero();      ///< reference point of `position` in W [m]
  std::vector<std::uint8_t> soil;  ///< index into FrameGround::soil_color
  /// Permanent ID of each particle, from which its appearance is derived. Empty: the array index is
  /// the ID.
  std::vector<std::uint32_t> id;
  double radius = 0.04;  ///< radius of a drawn particle [m]
  /// Distance of each particle from the closest plate of a tool [m]; the part of a drawn particle
  /// that extends further is clipped. Empty: no particle is clipped.
  std::vector<float> clearance;
  /// Unit vector in W from the closest plate to each particle, x, y, z; zero where no plate is
  /// near. Empty: unknown.
  std::vector<float> away;
};

/// A line through points in W, drawn over a picture.
struct FrameLine {
  std::vector<Vec3> points;  ///< points in W [m], at least two
  Color color;               ///< color as the picture shows it
  double width = 2;          ///< width [pixels]
  bool hidden = false;       ///< true: bodies and ground hide the parts behind them
};

/// A label at a point in W, drawn over a picture.
struct FrameLabel {
  Vec3 p_W = Vec3::Zero();  ///< left end of the text in W [m]
  std::string text;         ///< the text, one line
  Color color;              ///< color as the picture shows it
};

/// Lines and text over a picture that explain it.
struct FrameOverlay {
  std::vector<FrameLine> lines;    ///< lines
  std::vector<FrameLabel> labels;  ///< labels
  std::string caption;             ///< text along the upper edge, one line; empty: none

  /// Returns true if there is nothing to draw.
  bool empty() const { return lines.empty() && labels.empty() && caption.empty(); }
};

/// All input for drawing one picture. One thread may fill it while another draws an earlier one.
struct Frame {
  double time = 0;                       ///< simulated time [s]
  std::vector<FrameShape> shapes;        ///< visuals of all links
  std::vector<FrameCylinder> cylinders;  ///< hydraulic cylinders of all machines
  FrameGround ground;                    ///< surface of the ground at `time`
  FrameParticles particles;              ///< loose soil at `time`
  std::vector<Light> lights;             ///< lights of the scene; the first one casts shadows
  FrameOverlay overlay;                  ///< lines and text over the picture
};

/// Camera of one frame. In the camera frame C, x points right, y up, and the camera looks along -z,
/// as in OpenGL.
struct FrameCamera {
  Pose X_WC = Pose::Identity();    ///< pose of the camera in W
  double fov = radians(50);        ///< horizontal field of view [rad]
  int width = 1280, height = 720;  ///< width and height of the picture [pixels]
  int samples = 1;                 ///< samples per pixel, 1 or 4
};

}  // namespace navvy::scene
