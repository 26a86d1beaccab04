// SPDX-License-Identifier: Apache-2.0
// Records the active soil of a run as files.
#pragma once

#include <memory>
#include <string>

#include "formats/particle_files.h"
#include "formats/pvd_index.h"
#include "record/particle_record.h"
#include "record/run_folder.h"
#include "session/session.h"

namespace navvy::record {

/// Checks rate and format of a record. @throws InputError for a rate that is neither 0 nor from
/// 0.001 to 1000 per second, or an unknown format.
void check_particles(const ParticleRecord& record);

/// Writes the active soil at a rate into the run's folder.
///
/// There is one file `particles/particles_<number>.<extension>` per sample; <number> is the
/// simulated time times the rate, to half a base step. For VTU files there is also
/// `particles/particles.pvd`, the index from which ParaView opens all of them with their times.
/// After `restart`, names begin with `particles_2`, and so on. A step in which nothing is due costs
/// nothing; otherwise the cost is a pass over all particles and writing the file.
class ParticleRecorder {
 public:
  /// Prepares the record. `session` and `folder` must outlive this object. @throws as
  /// check_particles.
  ParticleRecorder(const session::Session& session, RunFolder& folder, ParticleRecord record);

  /// Writes a file if one is due. Must be called at the start of the run, after each step and after
  /// `restart`. @throws FileError if a file cannot be written.
  void observe();
  /// Begins files with another name. Must be called after the world was put into another state, for
  /// example by loading a snapshot.
  void restart();

 private:
  /// Returns the first part of the names of the files.
  std::string label() const;

  /// Session that is recorded.
  const session::Session& session_;
  /// Folder of the run.
  RunFolder& folder_;
  /// Rate and format.
  ParticleRecord record_;
  /// Format of the files.
  const formats::ParticleFormat& format_;
  /// Index of the VTU files; null for other formats and before the first file.
  std::unique_ptr<formats::PvdIndex> index_;
  /// Number of sequences of files so far: 1 plus the number of restarts.
  int sequence_ = 1;
};

}  // namespace navvy::record
