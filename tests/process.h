// SPDX-License-Identifier: Apache-2.0
// Starts another program with files as its standard streams, and waits for it.
#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

namespace navvy::test {

struct Command {
  std::string program;
  std::vector<std::string> arguments;
  std::vector<std::pair<std::string, std::string>> environment;  ///< set on top of the test's own
  std::string in = "/dev/null", out = "/dev/null", err = "/dev/null";
};

inline pid_t start(const Command& command) {
  const pid_t child = fork();
  if (child != 0) return child;
  for (const auto& [name, value] : command.environment) setenv(name.c_str(), value.c_str(), 1);
  dup2(::open(command.in.c_str(), O_RDONLY), 0);
  dup2(::open(command.out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644), 1);
  dup2(::open(command.err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644), 2);
  std::vector<char*> argv{const_cast<char*>(command.program.c_str())};
  for (const std::string& argument : command.arguments)
    argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  execv(command.program.c_str(), argv.data());
  _exit(127);
}

/// Waits for a process; returns its exit status, or minus the signal that ended it.
inline int wait_for(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

}  // namespace navvy::test
