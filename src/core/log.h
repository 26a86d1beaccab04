// SPDX-License-Identifier: Apache-2.0
// Log of the libraries. They never print: each message is passed to the sink that the program
// installs.
#pragma once

#include <functional>
#include <string>

namespace navvy {

/// Severity of a message. A warning says what was done instead of what was asked for. An error is a
/// message only; the caller throws the exception that goes with it.
enum class LogLevel { kInfo, kWarning, kError };

/// Takes one message, a line without its end. It is called from any thread that logs, so it must be
/// thread-safe, and it must not log itself.
using LogSink = std::function<void(LogLevel, const std::string&)>;

/// Replaces the sink; an empty function (the default) drops every message. Not thread-safe against
/// `log`: install the sink before threads start.
void set_log_sink(LogSink sink);
/// Passes one message to the sink. Without a sink it costs nothing but building the text. Throws
/// only what the sink throws.
void log(LogLevel level, const std::string& text);
/// Logs a message of level kInfo.
inline void log_info(const std::string& text) { log(LogLevel::kInfo, text); }
/// Logs a message of level kWarning.
inline void log_warning(const std::string& text) { log(LogLevel::kWarning, text); }

}  // namespace navvy
