// SPDX-License-Identifier: Apache-2.0
// The part that all sensors have in common: rate, sweep, latency, random numbers and publication.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "core/random.h"
#include "sensor/instrument.h"
#include "sim/sampler.h"

namespace navvy::sensor {

/// A sensor of a scene as a sampler of its world.
///
/// It looks at every step. A reading begins in the step that is nearest to its time n / rate. Its
/// columns are measured in the steps in which their instants lie, with the pose that the sensor has
/// at the instant, interpolated between the two ends of the step. After the latency it is
/// published, stamped with the time of its beginning. A sweep is at most as long as the time
/// between readings.
class SensorSampler final : public sim::Sampler {
 public:
  /// Creates the sensor; its random numbers follow from the scene's seed and its name.
  explicit SensorSampler(Mounting at);

  std::string name() const override { return name_; }
  // Every step: a sweep lasts several, and a delivery need not be at a reading.
  double rate() const override { return 0; }
  bool hashed() const override { return false; }
  void declare(sim::Publisher& out) override;
  void sample(const sim::World& world, sim::Publisher& out) override;
  void visit(Archive& a) override;

 private:
  /// A reading between measurement and delivery.
  struct Reading {
    double begun = 0, complete = 0;  ///< times of the first and the last column [s]
    Pose X_WS = Pose::Identity();    ///< pose of the sensor at the first column
    int columns = 0;                 ///< number of measured columns
    Values values;                   ///< measured values

    /// Visits all fields.
    void visit(Archive& a);
  };
  /// Measures the columns whose instants are not after `now` [s].
  void measure(double now, const Pose& X_WS);
  /// Measures the columns of one reading whose instants are not after `now` [s].
  void measure(Reading& reading, double now, const Pose& X_WS);
  /// Publishes the readings whose latency has passed.
  void deliver(double now, sim::Publisher& out);

  Mounting at_;
  std::string name_;
  Random random_;
  std::unique_ptr<Instrument> instrument_;
  std::vector<MeasuredQuantity> quantities_;
  std::vector<int> arrays_;  ///< index of each quantity in the publisher
  int counter_ = -1;         ///< index of the output that counts readings
  double delivered_ = 0;     ///< number of published readings
  /// Readings that are being measured, with fewer columns than the instrument has, or that wait for
  /// their delivery.
  std::deque<Reading> readings_;
  double last_begun_ = -1;               ///< beginning of the last reading [s]; -1: none
  double before_ = 0;                    ///< time of the last sample [s]
  Pose X_WS_before_ = Pose::Identity();  ///< pose of the sensor at the last sample
};

}  // namespace navvy::sensor
