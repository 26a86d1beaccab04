// SPDX-License-Identifier: Apache-2.0
// Takes bytes as an NPY file. The reader may refuse them with InputError only; an accepted array
// has the size it declares.
#include <sys/mman.h>
#include <unistd.h>

#include <string>

#include "core/error.h"
#include "heightfield/map_files/npy.h"
#include "target.h"

NAVVY_FUZZ_TARGET(npy) {
  const int file = ::memfd_create("npy", 0);
  if (file < 0) return 0;
  const std::string path = "/proc/self/fd/" + std::to_string(file);
  if (::write(file, data, size) == static_cast<ssize_t>(size)) {
    try {
      const navvy::heightfield::NpyGrid grid = navvy::heightfield::read_npy(path);
      static constexpr std::size_t kBytes[] = {4, 8, 2, 4, 2, 1};
      navvy::fuzz::hold(grid.rows > 0 && grid.columns > 0);
      navvy::fuzz::hold(grid.bytes.size() == static_cast<std::size_t>(grid.rows) *
                                                 static_cast<std::size_t>(grid.columns) *
                                                 kBytes[static_cast<int>(grid.type)]);
    } catch (const navvy::InputError&) {
    }
  }
  ::close(file);
  return 0;
}
