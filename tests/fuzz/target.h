// SPDX-License-Identifier: Apache-2.0
// Entry point of a fuzz target: libFuzzer's function in the preset fuzz, and a function named after
// the target in the plain build, where corpus_test.cpp passes the kept inputs to it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#ifdef NAVVY_FUZZ_REPLAY
#define NAVVY_FUZZ_TARGET(name) int fuzz_##name(const std::uint8_t* data, std::size_t size)
#else
#define NAVVY_FUZZ_TARGET(name) \
  extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
#endif

namespace navvy::fuzz {

/// Checks a property of accepted input and names the line of the check if it is broken; libFuzzer
/// keeps the input.
inline void hold(bool property, const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
  if (property) return;
  std::fprintf(stderr, "%s:%d: the input breaks this property\n", file, line);
  std::abort();
}

}  // namespace navvy::fuzz
