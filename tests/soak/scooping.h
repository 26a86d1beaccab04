// SPDX-License-Identifier: Apache-2.0
// A bucket that scoops and dumps the soil back repeatedly.
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

/// A session of scoops.sdf whose bucket repeats one path. Its commands depend only on the step's
/// number, so it continues from a snapshot as if it had not stopped.
class Scooping {
 public:
  /// Begins at the start, or from the snapshot `from`; results of the run go to `record` as with
  /// `navvy run`, unless it is empty. @throws InputError, FileError, device::DeviceError.
  Scooping(device::Device& device, const std::string& from, const std::string& record);
  /// Closes the results.
  ~Scooping();
  Scooping(const Scooping&) = delete;
  Scooping& operator=(const Scooping&) = delete;

  /// Runs until the empty bucket is back at its start. @throws SimulationError, FileError.
  void cycle();
  /// Number of cycles since the start, including those before a snapshot.
  long cycles() const;
  void save(const std::string& snapshot) const { session_->save(snapshot); }
  /// Present state; the caller sets wall time and process.
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
