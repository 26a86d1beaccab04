// SPDX-License-Identifier: Apache-2.0
// What one kind of sensor measures; sensor/sensor_sampler.h does what all kinds have in common.
#pragma once

#include <memory>
#include <vector>

#include "core/archive.h"
#include "core/math.h"
#include "core/random.h"
#include "scene/sensor.h"
#include "sensor/noise.h"
#include "sensor/ray_scene.h"
#include "sim/world.h"

namespace navvy::sensor {

// Forward declared: only colour cameras draw.
class PictureScene;

/// A sensor in its world.
struct Mounting {
  const sim::World& world;           ///< the world
  int machine, link;                 ///< indices of the carrying machine and link
  const scene::Sensor& description;  ///< the sensor as the scene describes it
  std::shared_ptr<RayScene> scene;   ///< what beams meet; shared by all sensors of the world
  /// Scene that colour cameras draw; shared by all sensors of the world.
  std::shared_ptr<PictureScene> pictures;

  /// Returns the handle of the carrying machine.
  sim::MachineHandle machine_handle() const { return world.machines().at(machine); }
  /// Returns the handle of the carrying link.
  sim::LinkHandle link_handle() const { return machine_handle().link(link); }
};

/// One array of a sensor: what ArrayChannel needs beside the sensor's name.
struct MeasuredQuantity {
  const char* name;        ///< last part of the array's name
  const char* unit;        ///< unit of the elements
  const char* meaning;     ///< one line of description
  sim::ElementType type;   ///< type of the elements
  std::vector<int> shape;  ///< lengths of the dimensions, the slowest first
};

/// Values of one reading: one list per quantity, in its order. They become the element type of the
/// quantity when they are published.
using Values = std::vector<std::vector<double>>;

/// Measures what one kind of sensor measures, at one instant or column by column.
///
/// An instrument reads the world and changes nothing. It draws random numbers only from the
/// generator that it is given, in an order that depends on nothing but the readings.
class Instrument {
 public:
  virtual ~Instrument() = default;
  /// Returns the arrays of a reading.
  virtual std::vector<MeasuredQuantity> quantities() const = 0;
  /// Returns true if it uses the ray scene, which is then up to date in `measure`.
  virtual bool looks() const { return false; }
  /// Returns the number of columns that are measured one after the other during the sweep; 1 for a
  /// sensor that measures at one instant.
  virtual int columns() const { return 1; }
  /// Returns the time from the first to the last column [s].
  virtual double sweep() const { return 0; }
  /// Called after each step of the world, for sensors that must not miss anything in between.
  virtual void follow() {}
  /// Measures column number `column`, at whose instant the sensor has the pose X_WS; the world is
  /// at the end of the step in which that instant lies.
  virtual void measure(int column, const Pose& X_WS, Values& out) = 0;
  /// Adds errors to a complete reading. `dt` is the time since the last reading [s].
  virtual void finish(Values& out, double dt, Random& random) = 0;
  /// Visits the state of the instrument.
  virtual void visit(Archive&) {}
};

/// Makes the instrument of one kind; sensor/kinds/ has one file per kind. Constant errors are drawn
/// from `random`.
std::unique_ptr<Instrument> make(const scene::Lidar& kind, const Mounting& at, Random& random);
std::unique_ptr<Instrument> make(const scene::Sonar& kind, const Mounting& at, Random& random);
std::unique_ptr<Instrument> make(const scene::Infrared& kind, const Mounting& at, Random& random);
std::unique_ptr<Instrument> make(const scene::TimeOfFlight& kind, const Mounting& at,
                                 Random& random);
std::unique_ptr<Instrument> make(const scene::Imu& kind, const Mounting& at, Random& random);
std::unique_ptr<Instrument> make(const scene::Gnss& kind, const Mounting& at, Random& random);
std::unique_ptr<Instrument> make(const scene::JointGauge& kind, const Mounting& at, Random& random);
std::unique_ptr<Instrument> make(const scene::CylinderPressure& kind, const Mounting& at,
                                 Random& random);
std::unique_ptr<Instrument> make(const scene::ContactSwitch& kind, const Mounting& at,
                                 Random& random);
std::unique_ptr<Instrument> make(const scene::ToolForce& kind, const Mounting& at, Random& random);
std::unique_ptr<Instrument> make(const scene::PayloadScale& kind, const Mounting& at,
                                 Random& random);
std::unique_ptr<Instrument> make(const scene::DepthCamera& kind, const Mounting& at,
                                 Random& random);
std::unique_ptr<Instrument> make(const scene::LabelCamera& kind, const Mounting& at,
                                 Random& random);

std::unique_ptr<Instrument> make(const scene::ColourCamera& kind, const Mounting& at,
                                 Random& random);
std::unique_ptr<Instrument> make(const scene::StereoCamera& kind, const Mounting& at,
                                 Random& random);
std::unique_ptr<Instrument> make(const scene::OwnMap& kind, const Mounting& at, Random& random);

}  // namespace navvy::sensor
