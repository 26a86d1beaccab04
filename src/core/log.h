// SPDX-License-Identifier: Apache-2.0
// Where libraries say things: they never print, they hand a line to whoever installed a sink (the program does).
#pragma once

#include <functional>
#include <string>

namespace navvy {

enum class LogLevel { kDebug, kInfo, kWarning, kError };

using LogSink = std::function<void(LogLevel, const std::string&)>;

/// Replaces the sink; an empty function (the state at start) drops every line. Not thread-safe against `log`.
void set_log_sink(LogSink sink);
void log(LogLevel level, const std::string& text);
inline void log_info(const std::string& text) { log(LogLevel::kInfo, text); }
inline void log_warning(const std::string& text) { log(LogLevel::kWarning, text); }

}  // namespace navvy
