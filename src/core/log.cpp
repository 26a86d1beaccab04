// SPDX-License-Identifier: Apache-2.0
#include "core/log.h"

#include <utility>

#include "core/printable.h"

namespace navvy {
namespace {
LogSink& sink() {
  // Created at first use, so that constructors of globals may log before main.
  static LogSink instance;
  return instance;
}
}  // namespace

void set_log_sink(LogSink replacement) { sink() = std::move(replacement); }

void log(LogLevel level, const std::string& text) {
  if (sink()) sink()(level, printable(text));
}

}  // namespace navvy
