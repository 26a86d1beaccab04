// SPDX-License-Identifier: Apache-2.0
#include "bench/row.h"

#include <cstdio>

namespace navvy::bench {
namespace {

// Column of the state hash: digits, but text to a reader.
constexpr std::size_t kHashColumn = 14;

std::string number(double value, const char* format) {
  // Zero, negative or NaN means that the column does not apply; an empty field cannot be averaged
  // by mistake.
  if (!(value > 0)) return "";
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// Text columns: some device names contain commas.
bool is_text(std::size_t column) { return column < 3 || column == kHashColumn; }

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      // Neither is allowed in CSV or JSON.
      out += c == '"' ? "'" : "/";
    else if (static_cast<unsigned char>(c) >= 0x20)
      out += c;
  }
  return out + "\"";
}

}  // namespace

// Scripts read files by these names, so a renamed column ends comparisons with committed results.
// kHashColumn and is_text depend on the order of the first ones.
const std::vector<std::string>& columns() {
  static const std::vector<std::string> names = {"bench",
                                                 "device",
                                                 "driver",
                                                 "particles",
                                                 "steps",
                                                 "min_ms",
                                                 "median_ms",
                                                 "spread",
                                                 "particle_steps_per_s",
                                                 "bytes_per_particle_step",
                                                 "share_of_copy_bandwidth",
                                                 "flops_per_particle_step",
                                                 "share_of_fma_peak",
                                                 "real_time_factor",
                                                 "state_hash",
                                                 "site_m",
                                                 "copy_bytes_per_s",
                                                 "fma_flops_per_s",
                                                 "processor_ms",
                                                 "kernel_ms",
                                                 "kernel_particle_steps_per_s",
                                                 "active_blocks",
                                                 "contact_nodes"};
  return names;
}

std::vector<std::string> cells(const Row& row) {
  // The fastest run counts everywhere, so that shares and rates of one row refer to the same run.
  const double best = row.timing.best;
  const double work = static_cast<double>(row.particles) * static_cast<double>(row.steps);
  const double rate = best > 0 ? work / best : 0;
  const auto share = [&](double each, double peak) { return peak > 0 ? rate * each / peak : 0; };
  return {row.bench,
          row.device,
          row.driver,
          std::to_string(row.particles),
          std::to_string(row.steps),
          number(best * 1e3, "%.4f"),
          number((row.timing.median > 0 ? row.timing.median : best) * 1e3, "%.4f"),
          number(row.timing.spread, "%.3f"),
          number(rate, "%.4g"),
          number(row.bytes_per_particle, "%.1f"),
          number(share(row.bytes_per_particle, row.peak.copy_bandwidth), "%.3f"),
          number(row.flops_per_particle, "%.0f"),
          number(share(row.flops_per_particle, row.peak.flops), "%.3f"),
          number(best > 0 ? row.simulated / best : 0, "%.3f"),
          row.hash,
          number(row.site, "%.0f"),
          number(row.peak.copy_bandwidth, "%.4g"),
          number(row.peak.flops, "%.4g"),
          number(row.timing.processor * 1e3, "%.1f"),
          number(row.kernels * 1e3, "%.4f"),
          number(row.kernels > 0 ? work / row.kernels : 0, "%.4g"),
          number(row.active_blocks, "%.0f"),
          number(row.contact_nodes, "%.0f")};
}

std::string csv_header() {
  std::string out;
  for (const std::string& name : columns()) out += (out.empty() ? "" : ",") + name;
  return out;
}

std::string csv_line(const Row& row) {
  const std::vector<std::string> fields = cells(row);
  std::string out;
  for (std::size_t k = 0; k < fields.size(); ++k) {
    if (k > 0) out += ",";
    // These two texts come from a driver and may contain anything; our own names contain no commas.
    out += k == 1 || k == 2 ? quoted(fields[k]) : fields[k];
  }
  return out;
}

std::string json(const std::vector<Row>& rows) {
  std::string out = "[";
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const std::vector<std::string> fields = cells(rows[r]);
    out += r > 0 ? ",\n {" : "\n {";
    bool first = true;
    for (std::size_t k = 0; k < fields.size(); ++k) {
      // An absent key means that nothing was measured; zero would be a value.
      if (fields[k].empty()) continue;
      out += (first ? "" : ", ") + quoted(columns()[k]) + ": " +
             (is_text(k) ? quoted(fields[k]) : fields[k]);
      first = false;
    }
    out += "}";
  }
  return out + "\n]\n";
}

}  // namespace navvy::bench
