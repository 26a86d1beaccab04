// SPDX-License-Identifier: Apache-2.0
// Messages of the libraries, kept until Python may log them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/log.h"

namespace navvy::python {

/// Installs a log sink that keeps messages. They cannot be passed on at once: the thread that logs
/// need not hold Python's lock. At most 1000 are kept.
void keep_messages();
/// Returns the messages since the last call, in order, and forgets them.
std::vector<std::pair<LogLevel, std::string>> take_messages();

/// Discards the messages of this thread while it lives: a copy of a world repeats the warnings of
/// its scene.
class QuietHere {
 public:
  QuietHere();
  ~QuietHere();
  QuietHere(const QuietHere&) = delete;
  QuietHere& operator=(const QuietHere&) = delete;
};

}  // namespace navvy::python
