// SPDX-License-Identifier: Apache-2.0
#include "core/long_work.h"

#include <atomic>

namespace navvy {
namespace {
std::atomic<const char*> current{nullptr};
}  // namespace

LongWork::LongWork(const char* what) noexcept : before_(current.exchange(what)) {}
LongWork::~LongWork() { current = before_; }

const char* long_work() noexcept { return current; }

}  // namespace navvy
