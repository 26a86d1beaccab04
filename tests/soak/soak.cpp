// SPDX-License-Identifier: Apache-2.0
#include "soak/soak.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "core/file.h"
#include "core/stopwatch.h"
#include "soak/scooping.h"

namespace navvy::soak {
namespace {

namespace fs = std::filesystem;

/// Paths of a plan's files.
struct Files {
  explicit Files(const std::string& folder)
      : phases(folder + "/phases.csv"),
        snapshot(folder + "/soak.snapshot"),
        quarter(folder + "/quarter.snapshot"),
        picture(folder + "/bytes.svg"),
        run(folder + "/run") {}
  std::string phases, snapshot, quarter, picture, run;
};

std::string if_there(const std::string& file) { return fs::exists(file) ? file : ""; }

bool stopped(const Plan& plan) { return plan.stop && plan.stop(); }

/// Runs the long run until the plan's cycles are done or the user stops it.
void run_on(device::Device& device, const Plan& plan, const Files& files) {
  std::vector<Phase> before = read_phases(files.phases);
  if (!before.empty() && before.back().cycle >= plan.cycles && fs::exists(files.snapshot)) return;
  Scooping scooping(device, if_there(files.snapshot), files.run);
  // Cycles after the snapshot are run again.
  before.erase(std::remove_if(before.begin(), before.end(),
                              [&](const Phase& phase) { return phase.cycle > scooping.cycles(); }),
               before.end());
  const int process = before.empty() ? 1 : before.back().process + 1;
  write_phases(files.phases, before);
  before = {};
  const Stopwatch watch;
  Stopwatch since_saved;
  while (scooping.cycles() < plan.cycles && !stopped(plan)) {
    scooping.cycle();
    Phase phase = scooping.phase();
    phase.process = process;
    phase.wall = watch.seconds();
    append_phase(files.phases, phase);
    if (plan.after_cycle) plan.after_cycle(phase.cycle);
    if (since_saved.seconds() < plan.save_every) continue;
    scooping.save(files.snapshot);
    since_saved.restart();
  }
  scooping.save(files.snapshot);
}

/// Returns the hash after `cycle` in the long run's table; empty if it has no such row.
std::string hash_after(const std::vector<Phase>& phases, long cycle) {
  for (const Phase& phase : phases)
    if (phase.cycle == cycle) return phase.hash;
  return "";
}

/// Runs four sessions in sequence, each from the snapshot of the one before, and reports
/// differences.
long run_quarters(device::Device& device, const Plan& plan, const Files& files,
                  std::vector<std::string>& broken) {
  const std::vector<Phase> phases = read_phases(files.phases);
  const long quarter = plan.cycles / 4;
  long done = 0;
  while (done < plan.cycles) {
    Scooping scooping(device, if_there(files.quarter), "");
    // A quarter of another plan is ignored.
    if (scooping.cycles() % quarter != 0 || scooping.cycles() > plan.cycles) {
      fs::remove(files.quarter);
      continue;
    }
    done = scooping.cycles();
    for (const long end = done + quarter; done < plan.cycles && done < end;
         done = scooping.cycles()) {
      if (stopped(plan)) return done / quarter * quarter;
      scooping.cycle();
    }
    const Phase phase = scooping.phase();
    if (phase.hash != hash_after(phases, done)) {
      broken.push_back("after cycle " + std::to_string(done) +
                       " the resumed quarters have the hash " + phase.hash +
                       ", the run in one piece " + hash_after(phases, done));
      // The next call tries all of it again.
      fs::remove(files.quarter);
      return done;
    }
    scooping.save(files.quarter);
  }
  return done;
}

}  // namespace

Result soak(device::Device& device, const Plan& plan) {
  fs::create_directories(plan.folder);
  const Files files(plan.folder);
  run_on(device, plan, files);
  Result out;
  {
    const std::vector<Phase> phases = read_phases(files.phases);
    out.reached = phases.empty() ? 0 : phases.back().cycle;
    out.processes = phases.empty() ? 0 : phases.back().process;
    out.hash = hash_after(phases, out.reached);
    out.grown = growth(phases, plan.allowance.cycles);
    out.broken = broken_claims(phases, plan.allowance);
    for (const Phase& phase : phases) {
      out.most.heap = std::max(out.most.heap, phase.bytes.heap);
      out.most.resident = std::max(out.most.resident, phase.bytes.resident);
      out.most.device = std::max(out.most.device, phase.bytes.device);
    }
    write_file_atomically(files.picture, picture(phases));
  }
  if (out.reached >= plan.cycles) out.compared = run_quarters(device, plan, files, out.broken);
  return out;
}

std::string summary(const Result& result, const Plan& plan) {
  const auto hours = [](long cycles) { return static_cast<double>(cycles) * kCycle / 3600; };
  const auto kib = [](std::int64_t bytes) { return static_cast<double>(bytes) / 1024; };
  char text[512];
  std::string out;
  std::snprintf(text, sizeof text,
                "%.3f of %.3f simulated hours, %ld cycles of %g s, in %d process%s\n",
                hours(result.reached), hours(plan.cycles), result.reached, kCycle, result.processes,
                result.processes == 1 ? "" : "es");
  out += text;
  const auto line = [&](const char* what, std::int64_t most, std::int64_t grown) {
    std::snprintf(text, sizeof text,
                  "  %-22s %10.1f KiB at most, %+.1f KiB after the first quarter\n", what,
                  kib(most), kib(grown));
    out += text;
  };
  line("allocated by malloc", result.most.heap, result.grown.heap);
  line("resident", result.most.resident, result.grown.resident);
  line("buffers of the device", result.most.device, result.grown.device);
  std::snprintf(text, sizeof text, "  state %s; resumed quarters equal up to %.3f h\n",
                result.hash.c_str(), hours(result.compared));
  out += text;
  for (const std::string& claim : result.broken) out += "  does not hold: " + claim + "\n";
  return out;
}

}  // namespace navvy::soak
