// SPDX-License-Identifier: Apache-2.0
// The virtual soil laboratory: rigs that measure one quantity of the soil, as a geotechnical laboratory does.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "scene/soil.h"

namespace navvy::device {
class Device;
}

namespace navvy::lab {

inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();  ///< "there is none" in a Quantity

/// One number that describes a rig's own geometry or procedure; the soil is not among them. SI units.
struct Parameter {
  std::string name;  ///< as on the command line, words joined by '-'
  double value = 0;  ///< default
  std::string unit;  ///< "" for a pure number
  std::string help;
};

/// What one experiment is made with. `geometry` holds every parameter of the rig (see default_setup).
struct Setup {
  device::Device* device = nullptr;
  scene::Soil soil;
  double cell = 0.1;                           ///< [m]
  std::map<std::string, double> geometry;      ///< by Parameter::name
  std::function<void(double share)> progress;  ///< called now and then with 0 .. 1; may be empty

  /// A parameter's value. @throws InputError naming the nearest parameter when the rig has none of this name.
  double operator[](const std::string& name) const;
  /// The same rounded, for counts and choices.
  int whole(const std::string& name) const;
};

/// One result. `expected` is what theory or the cited experiment says, `low` .. `high` the gate; kNone where there is
/// none. Units are those a reader wants (mm, deg, %), spelled out in `unit`.
struct Quantity {
  std::string name;
  double measured = kNone;
  std::string unit;
  double expected = kNone;
  double low = kNone, high = kNone;
  std::string source;

  bool has_gate() const;
  /// Outside the gate, or not a number; false without a gate.
  bool missed() const;
};

/// A recorded curve; series of one report have one length unless their names say otherwise.
struct Series {
  std::string name, unit;
  std::vector<double> values;
};

struct Report {
  std::vector<Quantity> results;
  std::vector<Series> series;
  int particles_peak = 0;
  std::uint64_t steps = 0;
  double simulated_time = 0, wall_time = 0;  ///< [s]
  std::int64_t ledger_error = 0;             ///< [kMassQuantum]; 0 = mass closed
  std::string state_hash;                    ///< of the soil at the end, repeatable on one device

  /// Adds a result with a gate around the expected value.
  void add(const std::string& name, double measured, const std::string& unit, double expected, double low, double high,
           const std::string& source);
  /// Adds a result without gate.
  void note(const std::string& name, double measured, const std::string& unit, const std::string& source = "");
  const Quantity* find(const std::string& name) const;  ///< null when there is none
};

/// One apparatus. `run` blocks until the experiment is over.
/// @throws InputError for a geometry that makes no sense, SimulationError when the soil stops itself.
struct Rig {
  std::string name;     ///< one word, or two joined by '-'
  std::string summary;  ///< one line
  std::string drawing;  ///< the rig in words, one paragraph: what stands where, what moves, what is read
  std::vector<Parameter> parameters;
  scene::Soil default_soil;
  double default_cell = 0.1;  ///< [m]
  Report (*run)(const Setup&) = nullptr;
};

/// Every rig, in the order in which a reader meets them.
const std::vector<Rig>& rigs();
/// @throws InputError naming the nearest rig.
const Rig& find_rig(const std::string& name);
/// Default soil, cell and geometry.
Setup default_setup(const Rig& rig, device::Device& device);
/// @throws InputError with every parameter that is not finite, negative or zero where that means nothing, or no choice.
void check(const Rig& rig, const Setup& setup);

}  // namespace navvy::lab
