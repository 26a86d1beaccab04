// SPDX-License-Identifier: Apache-2.0
#include "cli/progress_line.h"

#include <unistd.h>

#include <cstdio>

#include "core/stopwatch.h"

namespace navvy::cli {

std::function<void(double)> progress_line(bool quiet) {
  if (quiet || isatty(STDERR_FILENO) == 0) return {};
  // Carriage return and the clearing code keep it on one line; the last call clears it.
  return [watch = Stopwatch()](double share) {
    std::fprintf(stderr, "\r%3.0f %%  about %.0f s left \033[K", 100 * share,
                 watch.seconds() * (1 - share) / share);
    if (share >= 1) std::fputs("\r\033[K", stderr);
  };
}

}  // namespace navvy::cli
