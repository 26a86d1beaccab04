// SPDX-License-Identifier: Apache-2.0
#include "geometry/formats/read_in_child.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/saved_state.h"
#include "geometry/formats/mesh_builder.h"

namespace navvy::geometry {
namespace {

void visit_material(Archive& a, MeshMaterial& material) {
  a("name", material.name);
  a("diffuse", material.diffuse);
  a("specular", material.specular);
  a("shininess", material.shininess);
  a("opacity", material.opacity);
}

void visit_fault(Archive& a, Fault& fault) {
  a.ranged("severity", fault.severity, Fault::Severity::kError, Fault::Severity::kWarning);
  a("file", fault.file);
  a("line", fault.line);
  a("element", fault.element);
  a("value", fault.value);
  a("rule", fault.rule);
  a("remedy", fault.remedy);
}

/// Answer of the child: a mesh, faults, or the text of another exception.
struct Answer {
  TriangleMesh mesh;
  std::vector<Fault> faults;
  std::string failure;

  void visit(Archive& a) {
    a("vertices", mesh.vertices);
    a("triangles", mesh.triangles);
    a("material_of", mesh.material_of);
    mesh.materials.resize(a.size("materials", mesh.materials.size()));
    for (std::size_t i = 0; i < mesh.materials.size(); ++i)
      a.item(i, [&] { visit_material(a, mesh.materials[i]); });
    faults.resize(a.size("faults", faults.size()));
    for (std::size_t i = 0; i < faults.size(); ++i) a.item(i, [&] { visit_fault(a, faults[i]); });
    a("failure", failure);
  }
};

/// Gives the child the signals of a plain process. The parent's handlers would write reports and
/// snapshots of a run that is not the child's, and its mask would keep Ctrl-C from ending it.
void forget_handlers() {
  for (const int signal :
       {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTERM, SIGINT, SIGHUP, SIGPIPE})
    std::signal(signal, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  pthread_sigmask(SIG_SETMASK, &none, nullptr);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
}

/// Reads and sends the answer, in the child. Returns true if all of it was sent.
bool answer(int out, const std::function<TriangleMesh()>& read) {
  Answer reply;
  try {
    reply.mesh = read();
  } catch (const InputError& refused) {
    reply.faults = refused.faults();
  } catch (const std::exception& failed) {
    reply.failure = failed.what();
  }
  const std::vector<char> bytes = saved(reply);
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t n = ::write(out, bytes.data() + sent, bytes.size() - sent);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    sent += static_cast<std::size_t>(n);
  }
  return true;
}

/// Runs the child to its end. Nothing may unwind into the parent's frames: neither their handlers
/// nor the parent's buffers are the child's.
[[noreturn]] void run_child(const int (&ends)[2],
                            const std::function<TriangleMesh()>& read) noexcept {
  bool sent = false;
  try {
    // Without it, a child whose parent has died would wait for a reader for ever.
    ::close(ends[0]);
    forget_handlers();
    sent = answer(ends[1], read);
  } catch (...) {
  }
  ::_exit(sent ? 0 : 1);
}

std::vector<char> all_bytes(int in) {
  std::vector<char> bytes;
  std::vector<char> part(1 << 16);
  for (;;) {
    const ssize_t n = ::read(in, part.data(), part.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return bytes;
    bytes.insert(bytes.end(), part.begin(), part.begin() + n);
  }
}

/// Waits for the child. Returns how it ended; empty if well, or if the program ignores children.
/// @throws Error if somebody has ended it
std::string end_of(const std::string& path, pid_t child) {
  int status = 0;
  pid_t ended = 0;
  do ended = ::waitpid(child, &status, 0);
  while (ended < 0 && errno == EINTR);
  if (ended != child || (WIFEXITED(status) && WEXITSTATUS(status) == 0)) return "";
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (signal == SIGINT || signal == SIGTERM || signal == SIGHUP || signal == SIGKILL)
    throw Error(path + ": reading it was ended: " + ::strsignal(signal));
  if (signal != 0) return ::strsignal(signal);
  return "exit status " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

TriangleMesh read_in_child(const std::string& path, const std::string& library,
                           const std::function<TriangleMesh()>& read) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    throw Error(path + ": no pipe for reading it: " + std::strerror(errno));
  const pid_t child = ::fork();
  if (child < 0) {
    const int reason = errno;
    ::close(ends[0]);
    ::close(ends[1]);
    throw Error(path + ": no process for reading it: " + std::strerror(reason));
  }
  if (child == 0) run_child(ends, read);
  ::close(ends[1]);
  std::vector<char> bytes = all_bytes(ends[0]);
  ::close(ends[0]);
  const std::string ended = end_of(path, child);
  if (!ended.empty() || bytes.empty())
    refuse_mesh(
        path, 0, "",
        library + ", which reads it, has crashed" + (ended.empty() ? "" : " (" + ended + ")"),
        "the file is damaged: copy or export it again, or export it as OBJ");
  Answer reply;
  try {
    load_saved(std::move(bytes), reply);
  } catch (const InputError& broken) {
    refuse_mesh(path, 0, "", library + " failed: " + broken.what());
  }
  if (!reply.faults.empty()) throw InputError(std::move(reply.faults));
  if (!reply.failure.empty()) refuse_mesh(path, 0, "", library + " failed: " + reply.failure);
  require_valid(reply.mesh, path);
  return std::move(reply.mesh);
}

}  // namespace navvy::geometry
