// SPDX-License-Identifier: Apache-2.0
// Preloaded into a program, makes one of its calls fail, or its OpenCL driver hang.
//
// NAVVY_FAULT=call:n:errno makes the n-th call (from 1) fail; call:n+:errno that one and all after
// it. `call` is open, write, fsync, rename (each with its relatives; write of regular files only),
// new (operator new called from the program's own code, by whatever thread, once main has begun:
// sigaltstack shows it) or buffer (clCreateBuffer, which says that the device has no memory left,
// whatever the errno). With n+ and write, what lies within a file's present size still succeeds, as
// on a full disk. NAVVY_FAULT_COUNT=FILE appends the number of calls of each kind when the program
// ends. NAVVY_FAULT_TRACE=1 prints who made the failing call. NAVVY_HANG=build:n:seconds lets the
// OpenCL driver hang in its n-th build of a program and in those after it;
// NAVVY_HANG=wait:n:seconds in the calls that wait for the device; NAVVY_HANG=thrown:n:seconds
// throws out of the n-th build, and hangs where any program is released from then on.
// NAVVY_ABORT=abort:n and NAVVY_ABORT=assert:n end the process at the first file that the driver
// opens in its n-th build, by abort() or by an assertion that fails; NAVVY_ABORT=own:n by abort()
// at the n-th allocation of the program's own code.
#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <new>

// If assertions are disabled, its header does not declare it.
extern "C" [[noreturn]] void __assert_fail(const char* what, const char* file,
                                           unsigned line,  // NOLINT: its name
                                           const char* function) noexcept;

namespace {

enum Call { kOpen, kWrite, kFsync, kRename, kNew, kBuffer, kCalls };
const char* const kNames[kCalls] = {"open", "write", "fsync", "rename", "new", "buffer"};

std::atomic<long> counts[kCalls];
// Kind of the failing call.
int failing = -1;
// Number of the failing call.
long at = 0;
bool from_there_on = false;
int code = 0;
std::atomic<bool> begun{false};
// Address range of the program's code.
std::uintptr_t own_begin = 0, own_end = 0;

struct {
  const char* name;
  int value;
} const kCodes[] = {
    {"ENOSPC", ENOSPC}, {"EIO", EIO}, {"EMFILE", EMFILE}, {"ENOMEM", ENOMEM}, {"EACCES", EACCES}};

// The first object of the list is the program itself.
int find_program(dl_phdr_info* info, std::size_t, void*) {
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    const auto& header = info->dlpi_phdr[i];
    if (header.p_type != PT_LOAD || (header.p_flags & PF_X) == 0) continue;
    own_begin = info->dlpi_addr + header.p_vaddr;
    own_end = own_begin + header.p_memsz;
  }
  return 1;
}

__attribute__((constructor)) void read_environment() {
  dl_iterate_phdr(find_program, nullptr);
  const char* text = getenv("NAVVY_FAULT");
  if (text == nullptr) return;
  char call[16] = {}, number[32] = {}, name[16] = {};
  if (std::sscanf(text, "%15[^:]:%31[^:]:%15s", call, number, name) != 3) return;
  for (int i = 0; i < kCalls; ++i)
    if (std::strcmp(call, kNames[i]) == 0) failing = i;
  at = std::atol(number);
  from_there_on = std::strchr(number, '+') != nullptr;
  for (const auto& one : kCodes)
    if (std::strcmp(name, one.name) == 0) code = one.value;
}

__attribute__((destructor)) void print_counts() {
  const char* path = getenv("NAVVY_FAULT_COUNT");
  if (path == nullptr) return;
  const int file =
      static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_CREAT | O_APPEND, 0644));
  if (file < 0) return;
  char line[64];
  for (int i = 0; i < kCalls; ++i) {
    const int n = std::snprintf(line, sizeof line, "%s %ld\n", kNames[i], counts[i].load());
    syscall(SYS_write, file, line, n);
  }
  syscall(SYS_close, file);
}

// True while the driver is in a build that is to be its last.
std::atomic<bool> last_build{false};
/// Returns true if NAVVY_ABORT requests `kind` for call `number`.
bool aborts(const char* kind, long number) {
  const char* text = getenv("NAVVY_ABORT");
  const std::size_t size = std::strlen(kind);
  return text != nullptr && std::strncmp(text, kind, size) == 0 && text[size] == ':' &&
         std::atol(text + size + 1) == number;
}
/// Called by the driver, deep inside its own calls.
void end_here(Call call) {
  if (call != kOpen || !last_build.exchange(false)) return;
  if (std::strncmp(getenv("NAVVY_ABORT"), "assert", 6) == 0)
    __assert_fail("the cache is sound", "driver.c", 7, "build");
  std::abort();
}

bool fails(Call call) {
  end_here(call);
  const long n = ++counts[call];
  if (call != failing || (from_there_on ? n < at : n != at)) return false;
  if (getenv("NAVVY_FAULT_TRACE") != nullptr) {
    void* frames[40];
    backtrace_symbols_fd(frames, backtrace(frames, 40), 2);
  }
  errno = code;
  return true;
}

bool is_file(int file) {
  struct stat found;
  return file > 2 && fstat(file, &found) == 0 && S_ISREG(found.st_mode);
}

/// Returns true if this write is the one that fails. `offset` below zero: at the file's current
/// position.
bool write_fails(int file, std::size_t size, off_t offset) {
  if (!is_file(file)) return false;
  struct stat found;
  if (failing == kWrite && from_there_on && fstat(file, &found) == 0) {
    const off_t begin = offset >= 0 ? offset : lseek(file, 0, SEEK_CUR);
    if ((fcntl(file, F_GETFL) & O_APPEND) == 0 && begin >= 0 &&
        begin + static_cast<off_t>(size) <= found.st_size) {
      ++counts[kWrite];
      return false;
    }
  }
  return fails(kWrite);
}

template <class F>
F next(const char* name) {
  return reinterpret_cast<F>(dlsym(RTLD_NEXT, name));
}

mode_t mode_of(int flags, va_list list) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(list, mode_t) : 0;
}

void* thrown_out_of = nullptr;
std::atomic<long> builds{0};
std::atomic<long> waits{0};
void hang(const char* call) {
  const char* text = getenv("NAVVY_HANG");
  char name[32] = {};
  long from = 0, seconds = 0;
  if (text == nullptr || std::sscanf(text, "%31[^:]:%ld:%ld", name, &from, &seconds) != 3) return;
  if (std::strcmp(name, call) != 0 || ++waits < from) return;
  timespec left{seconds, 0};
  // A driver does not return on a signal.
  while (nanosleep(&left, &left) != 0) {
  }
}

}  // namespace

#define NEXT(function) static const auto real = next<decltype(&(function))>(#function)

extern "C" {

#define OPEN(function, ...)                                       \
  va_list list;                                                   \
  va_start(list, flags);                                          \
  const mode_t mode = mode_of(flags, list);                       \
  va_end(list);                                                   \
  static const auto real = next<int (*)(__VA_ARGS__)>(#function); \
  if (fails(kOpen)) return -1;

int open(const char* path, int flags, ...) {
  OPEN(open, const char*, int, ...)
  return real(path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  OPEN(open64, const char*, int, ...)
  return real(path, flags, mode);
}
int openat(int folder, const char* path, int flags, ...) {
  OPEN(openat, int, const char*, int, ...)
  return real(folder, path, flags, mode);
}
int openat64(int folder, const char* path, int flags, ...) {
  OPEN(openat64, int, const char*, int, ...)
  return real(folder, path, flags, mode);
}
FILE* fopen(const char* path, const char* mode) {
  NEXT(fopen);
  return fails(kOpen) ? nullptr : real(path, mode);
}
FILE* fopen64(const char* path, const char* mode) {
  NEXT(fopen64);
  return fails(kOpen) ? nullptr : real(path, mode);
}

ssize_t write(int file, const void* data, size_t size) {
  NEXT(write);
  return write_fails(file, size, -1) ? -1 : real(file, data, size);
}
ssize_t pwrite(int file, const void* data, size_t size, off_t offset) {
  NEXT(pwrite);
  return write_fails(file, size, offset) ? -1 : real(file, data, size, offset);
}
ssize_t pwrite64(int file, const void* data, size_t size, off64_t offset) {
  NEXT(pwrite64);
  return write_fails(file, size, offset) ? -1 : real(file, data, size, offset);
}
ssize_t writev(int file, const iovec* parts, int count) {
  NEXT(writev);
  std::size_t size = 0;
  for (int i = 0; i < count; ++i) size += parts[i].iov_len;
  return write_fails(file, size, -1) ? -1 : real(file, parts, count);
}
size_t fwrite(const void* data, size_t size, size_t count, FILE* file) {
  NEXT(fwrite);
  return write_fails(fileno(file), size * count, -1) ? 0 : real(data, size, count, file);
}

int sigaltstack(const stack_t* now, stack_t* before) noexcept {
  NEXT(sigaltstack);
  begun = true;
  return real(now, before);
}

int fsync(int file) {
  NEXT(fsync);
  return fails(kFsync) ? -1 : real(file);
}
int fdatasync(int file) {
  NEXT(fdatasync);
  return fails(kFsync) ? -1 : real(file);
}
int rename(const char* from, const char* to) {
  NEXT(rename);
  return fails(kRename) ? -1 : real(from, to);
}
int renameat(int from_folder, const char* from, int to_folder, const char* to) {
  NEXT(renameat);
  return fails(kRename) ? -1 : real(from_folder, from, to_folder, to);
}

void* clCreateBuffer(void* context, std::uint64_t flags, std::size_t size, void* host,
                     int* result) {
  static const auto real =
      next<void* (*)(void*, std::uint64_t, std::size_t, void*, int*)>("clCreateBuffer");
  constexpr int kNoMemory = -4;  // CL_MEM_OBJECT_ALLOCATION_FAILURE
  if (!fails(kBuffer)) return real(context, flags, size, host, result);
  if (result != nullptr) *result = kNoMemory;
  return nullptr;
}
int clFinish(void* queue) {
  static const auto real = next<int (*)(void*)>("clFinish");
  hang("wait");
  return real(queue);
}
void* clEnqueueMapBuffer(void* queue, void* buffer, unsigned blocking, std::uint64_t flags,
                         std::size_t offset, std::size_t size, unsigned waits_for, const void* list,
                         void* event, int* result) {
  static const auto real =
      next<void* (*)(void*, void*, unsigned, std::uint64_t, std::size_t, std::size_t, unsigned,
                     const void*, void*, int*)>("clEnqueueMapBuffer");
  if (blocking != 0) hang("wait");
  return real(queue, buffer, blocking, flags, offset, size, waits_for, list, event, result);
}
int clEnqueueReadBuffer(void* queue, void* buffer, unsigned blocking, std::size_t offset,
                        std::size_t size, void* to, unsigned waits_for, const void* list,
                        void* event) {
  static const auto real = next<int (*)(void*, void*, unsigned, std::size_t, std::size_t, void*,
                                        unsigned, const void*, void*)>("clEnqueueReadBuffer");
  if (blocking != 0) hang("wait");
  return real(queue, buffer, blocking, offset, size, to, waits_for, list, event);
}
int clReleaseProgram(void* program) {
  static const auto real = next<int (*)(void*)>("clReleaseProgram");
  timespec left{600, 0};
  // The lock belongs to the compiler: no program gets past it, whichever build threw.
  while (thrown_out_of != nullptr && nanosleep(&left, &left) != 0) {
  }
  return real(program);
}
int clBuildProgram(void* program, unsigned count, const void* devices, const char* options,
                   void* notify, void* data) {
  static const auto real =
      next<int (*)(void*, unsigned, const void*, const char*, void*, void*)>("clBuildProgram");
  hang("build");
  const char* text = getenv("NAVVY_HANG");
  if (text != nullptr && std::strncmp(text, "thrown:", 7) == 0 && ++builds == std::atol(text + 7)) {
    thrown_out_of = program;
    throw std::bad_alloc();
  }
  static std::atomic<long> built{0};
  const long number = ++built;
  last_build = aborts("abort", number) || aborts("assert", number);
  const int result = real(program, count, devices, options, notify, data);
  last_build = false;
  return result;
}

}  // extern "C"

namespace {

bool new_fails(void* caller) {
  const auto place = reinterpret_cast<std::uintptr_t>(caller);
  if (!begun || place < own_begin || place >= own_end) return false;
  static std::atomic<long> made{0};
  if (aborts("own", ++made)) std::abort();
  return fails(kNew);
}

}  // namespace

// Allocations of the standard library for the program count as its own, since they are compiled
// into it.
void* operator new(std::size_t size) {
  if (new_fails(__builtin_return_address(0))) throw std::bad_alloc();
  void* memory = std::malloc(size == 0 ? 1 : size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
