// SPDX-License-Identifier: Apache-2.0
#include "soak/phase.h"

#include <malloc.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/error.h"
#include "core/file.h"

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define NAVVY_ADDRESS_SANITIZER
#include <sanitizer/allocator_interface.h>
#endif
#endif

namespace navvy::soak {
namespace {

const char* const kHeader =
    "cycle,simulated_s,wall_s,process,heap_bytes,resident_bytes,device_bytes,particles,ledger_"
    "units,state_hash";

#ifdef NAVVY_ADDRESS_SANITIZER
/// The sanitizer has an allocator of its own.
std::int64_t heap_in_use() {
  return static_cast<std::int64_t>(__sanitizer_get_current_allocated_bytes());
}
#else
/// Returns the number after the last `mark` of the C library's report, in size="...".
std::int64_t size_after(const std::string& report, const std::string& mark) {
  const std::size_t at = report.rfind(mark);
  if (at == std::string::npos) return 0;
  const std::size_t size = report.find("size=\"", at);
  return size == std::string::npos ? 0 : std::atoll(report.c_str() + size + 6);
}

/// mallinfo2 reports only the main arena, but every thread of the driver has its own.
std::int64_t heap_in_use() {
  char* text = nullptr;
  std::size_t length = 0;
  std::FILE* const stream = open_memstream(&text, &length);
  if (stream == nullptr) return 0;
  malloc_info(0, stream);
  std::fclose(stream);
  const std::string report(text, length);
  std::free(text);
  // The sums over all arenas come last; large blocks, which are mapped individually, are in none.
  return size_after(report, "<system type=\"current\"") -
         size_after(report, "<total type=\"fast\"") - size_after(report, "<total type=\"rest\"") +
         size_after(report, "<total type=\"mmap\"");
}
#endif

std::int64_t resident() {
  std::int64_t all = 0, pages = 0;
  std::ifstream("/proc/self/statm") >> all >> pages;
  return pages * sysconf(_SC_PAGESIZE);
}

std::string row(const Phase& p) {
  char text[256];
  std::snprintf(text, sizeof text, "%ld,%.3f,%.1f,%d,%lld,%lld,%lld,%d,%lld,", p.cycle, p.time,
                p.wall, p.process, static_cast<long long>(p.bytes.heap),
                static_cast<long long>(p.bytes.resident), static_cast<long long>(p.bytes.device),
                p.particles, static_cast<long long>(p.ledger));
  return text + p.hash + "\n";
}

}  // namespace

Bytes bytes_in_use(std::uint64_t device) {
  return {heap_in_use(), resident(), static_cast<std::int64_t>(device)};
}

std::vector<Phase> read_phases(const std::string& path) {
  std::vector<Phase> out;
  if (!std::filesystem::exists(path)) return out;
  std::ifstream in(path);
  std::string line;
  // A last row without its line end is incomplete.
  for (int number = 1; std::getline(in, line) && !in.eof(); ++number) {
    if (number == 1) continue;
    for (char& c : line)
      if (c == ',') c = ' ';
    std::istringstream cells(line);
    Phase p;
    cells >> p.cycle >> p.time >> p.wall >> p.process >> p.bytes.heap >> p.bytes.resident >>
        p.bytes.device >> p.particles >> p.ledger >> p.hash;
    if (!cells)
      throw InputError(Fault{Fault::Severity::kError, path, number, "row", line,
                             "must be a row of a soak's table", "remove the folder to start over"});
    out.push_back(p);
  }
  return out;
}

void write_phases(const std::string& path, const std::vector<Phase>& phases) {
  std::string text = std::string(kHeader) + "\n";
  for (const Phase& phase : phases) text += row(phase);
  write_file_atomically(path, text);
}

void append_phase(const std::string& path, const Phase& phase) {
  std::ofstream out(path, std::ios::app);
  out << row(phase);
  out.close();
  if (!out) throw FileError("cannot append to '" + path + "'");
}

}  // namespace navvy::soak
