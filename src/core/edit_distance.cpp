// SPDX-License-Identifier: Apache-2.0
#include "core/edit_distance.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace navvy {

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t keep = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({keep, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

std::string nearest_name(const std::vector<std::string>& names, const std::string& wanted) {
  std::string nearest;
  std::size_t least = static_cast<std::size_t>(-1);
  for (const std::string& name : names) {
    const std::size_t distance = edit_distance(name, wanted);
    if (distance < least) least = distance, nearest = name;
  }
  return nearest;
}

}  // namespace navvy
