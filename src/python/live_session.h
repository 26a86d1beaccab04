// SPDX-License-Identifier: Apache-2.0
// A session with its own queue on the OpenCL device, as every world of Python has.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "device/device.h"
#include "scene/scene.h"
#include "session/session.h"

namespace navvy::python {

/// A session and its device. Worlds of one process share context and kernel programs, and each has
/// a queue of its own, so that several threads may step several worlds.
class LiveSession {
 public:
  /// Options of a world, beside its scene.
  struct Options {
    /// OpenCL device, as for device::Device.
    std::string device;
    /// Links, as "machine/link", whose pose and velocities are added to the outputs.
    std::vector<std::string> watch;
  };
  /// Builds the world of `scene` with its sensors.
  /// @throws InputError, device::DeviceError as session::Session does.
  LiveSession(scene::Scene scene, const Options& options);

  /// Returns the session.
  session::Session& session() { return *session_; }
  const session::Session& session() const { return *session_; }
  /// Returns the state at the end of the constructor, as `saved` returns it.
  const std::vector<char>& start() const { return start_; }
  /// Replaces the state by `state`, which `saved` returned for the same scene; no check of damage.
  void load(const std::vector<char>& state);

 private:
  // The session refers to the device, so it is destroyed first.
  device::Device device_;
  std::unique_ptr<session::Session> session_;
  std::vector<char> start_;
};

}  // namespace navvy::python
