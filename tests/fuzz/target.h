// SPDX-License-Identifier: Apache-2.0
// One function a target: libFuzzer's entry under the preset fuzz, and a function of its own name in
// the plain build, where corpus_test.cpp gives it the kept inputs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>

#ifdef NAVVY_FUZZ_REPLAY
#define NAVVY_FUZZ_TARGET(name) int fuzz_##name(const std::uint8_t* data, std::size_t size)
#else
#define NAVVY_FUZZ_TARGET(name) \
  extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
#endif

namespace navvy::fuzz {

/// A property that holds for whatever was let in; libFuzzer keeps the input for which it does not.
inline void hold(bool property) {
  if (!property) std::abort();
}

}  // namespace navvy::fuzz
