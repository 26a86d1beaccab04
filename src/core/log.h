// SPDX-License-Identifier: Apache-2.0
// Log of the libraries. Libraries never print: each message is passed to a function, the sink,
// which the program installs.
#pragma once

#include <functional>
#include <string>

namespace navvy {

/// Severity of a message. A warning states what Navvy did instead of what was requested. An error
/// message does not stop anything by itself; the code that logs it also throws an exception.
enum class LogLevel { kInfo, kWarning, kError };

/// Function that receives each message, one line without a line end. Any thread may call it, so it
/// must be thread-safe. It must not log messages itself.
using LogSink = std::function<void(LogLevel, const std::string&)>;

/// Replaces the sink. With an empty function, which is the default, messages are discarded. Must
/// not run at the same time as `log`: install the sink before starting threads.
void set_log_sink(LogSink sink);
/// Passes one message to the sink, if there is one. Throws only what the sink throws.
void log(LogLevel level, const std::string& text);
/// Logs a message with the level kInfo.
inline void log_info(const std::string& text) { log(LogLevel::kInfo, text); }
/// Logs a message with the level kWarning.
inline void log_warning(const std::string& text) { log(LogLevel::kWarning, text); }

}  // namespace navvy
