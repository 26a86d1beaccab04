// SPDX-License-Identifier: Apache-2.0
// A bucket that scoops and dumps back, for ever the same.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "device/device.h"
#include "record/recorder.h"
#include "session/session.h"
#include "soak/phase.h"

namespace navvy::soak {

constexpr double kCycle = 6;  ///< simulated [s]

/// A session of scoops.sdf whose bucket follows one path again and again. What it is told depends
/// on the step's number alone, so it goes on from a snapshot as if it had never stopped.
class Scooping {
 public:
  /// From the start, or from the snapshot `from`; results of the run go to `record` as `navvy run`
  /// leaves them, unless it is empty. @throws InputError, FileError, device::DeviceError.
  Scooping(device::Device& device, const std::string& from, const std::string& record);
  /// Closes the results.
  ~Scooping();
  Scooping(const Scooping&) = delete;
  Scooping& operator=(const Scooping&) = delete;

  /// Until the bucket is back where it began, empty. @throws SimulationError, FileError.
  void cycle();
  /// Done since the start, those before a snapshot too.
  long cycles() const;
  void save(const std::string& snapshot) const { session_->save(snapshot); }
  /// How it stands; wall time and process are the caller's.
  Phase phase() const;

 private:
  void command(double time_in_cycle);

  device::Device& device_;
  std::unique_ptr<session::Session> session_;
  std::unique_ptr<record::Recorder> recorder_;
  std::array<int, 3> inputs_{};
  std::uint64_t steps_in_cycle_ = 0;
};

}  // namespace navvy::soak
