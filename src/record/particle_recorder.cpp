// SPDX-License-Identifier: Apache-2.0
#include "record/particle_recorder.h"

#include <cstdio>
#include <utility>

#include "core/error.h"
#include "sim/read_particles.h"
#include "sim/timing.h"

namespace navvy::record {
namespace {

/// Lowest and highest rate [1/s]. Base steps are rarely shorter than a millisecond.
constexpr double kLowestRate = 0.001, kHighestRate = 1000;

/// Checks the record before its format is looked up.
ParticleRecord checked(ParticleRecord record) {
  check_particles(record);
  return record;
}

}  // namespace

// Comparisons with NaN are false, so NaN is refused.
void check_particles(const ParticleRecord& record) {
  if (record.rate == 0) return;
  if (!(record.rate >= kLowestRate && record.rate <= kHighestRate)) {
    char rate[40];
    std::snprintf(rate, sizeof rate, "%g", record.rate);
    throw InputError(Fault{Fault::Severity::kError, "", 0, "--particles", rate,
                           "is not a rate from 0.001 to 1000 files per simulated second",
                           "each file holds all particles; 10 is enough for an animation"});
  }
  formats::particle_format_named(record.format);
}

ParticleRecorder::ParticleRecorder(const session::Session& session, RunFolder& folder,
                                   ParticleRecord record)
    : session_(session),
      folder_(folder),
      record_(checked(std::move(record))),
      format_(formats::particle_format_named(record_.format)) {}

std::string ParticleRecorder::label() const {
  return sequence_ == 1 ? "particles" : "particles_" + std::to_string(sequence_);
}

// Times are compared as step counts, so that rates hold exactly over days.
void ParticleRecorder::observe() {
  const sim::World& world = session_.world();
  if (record_.rate == 0 || !sim::sample_due(world.steps(), world.dt(), record_.rate)) return;
  // Up to number 999999, sorting by name gives the order in time.
  char number[24];
  std::snprintf(
      number, sizeof number, "_%06llu",
      static_cast<unsigned long long>(sim::sample_number(world.steps(), world.dt(), record_.rate)));
  const std::string name = label() + number + format_.extension;
  // A file is listed as the run's before it exists.
  const std::string path = folder_.path("particles/" + name);
  format_.write(sim::read_particles(world), path);
  if (format_.name != "vtu") return;
  if (!index_)
    index_ = std::make_unique<formats::PvdIndex>(folder_.path("particles/" + label() + ".pvd"));
  index_->add(world.time(), name);
}

void ParticleRecorder::restart() {
  ++sequence_;
  index_.reset();
}

}  // namespace navvy::record
