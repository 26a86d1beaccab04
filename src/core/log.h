// SPDX-License-Identifier: Apache-2.0
// Where libraries say things: they never print, they hand a line to whoever installed a sink (the
// program does).
#pragma once

#include <functional>
#include <string>

namespace navvy {

/// How much a person should care. A warning says what was done instead of what was asked for; an
/// error is a line only, the exception that goes with it is thrown by the caller. Debug lines are
/// for whoever works on the library.
enum class LogLevel { kDebug, kInfo, kWarning, kError };

/// Takes one line without its end. It is called from whatever thread logs, so it guards itself. It
/// must not log itself.
using LogSink = std::function<void(LogLevel, const std::string&)>;

/// Replaces the sink; an empty function (the state at start) drops every line. Not thread-safe
/// against `log`. Install it before threads start.
void set_log_sink(LogSink sink);
/// Hands one line to the sink. Costs nothing but the text when there is none; never throws of its
/// own.
void log(LogLevel level, const std::string& text);
// Short forms for what libraries say most.
inline void log_info(const std::string& text) { log(LogLevel::kInfo, text); }
inline void log_warning(const std::string& text) { log(LogLevel::kWarning, text); }

}  // namespace navvy
