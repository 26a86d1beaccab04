// SPDX-License-Identifier: Apache-2.0
#include "core/hash.h"

namespace navvy {

std::string StateHash::hex() const {
  static const char* digits = "0123456789abcdef";
  std::string out(16, '0');
  // Most significant digit first, so that texts compare like the numbers.
  for (int i = 0; i < 16; ++i) out[15 - i] = digits[(state_ >> (4 * i)) & 15];
  return out;
}

}  // namespace navvy
