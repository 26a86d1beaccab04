// SPDX-License-Identifier: Apache-2.0
// Compares the table of column records with a std::map of the same content.
#include "coupling/column_table.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <map>

#include "core/error.h"
#include "core/random.h"
#include "core/saved_state.h"
#include "flip_bytes.h"

namespace navvy::coupling {
namespace {

struct Value {
  double number = 0;
  void visit(Archive& a) { a("number", number); }
};

/// Reference container.
struct Map {
  std::map<std::int64_t, Value> values;
  void visit(Archive& a) { a("values", values); }
};

constexpr int kNx = 75, kNy = 9;  // neither is a multiple of a strip

class ColumnTables : public ::testing::Test {
 protected:
  ColumnTables() {
    Random random(7);
    for (int i = 0; i < 400; ++i) {
      const int ix = static_cast<int>(random.uniform() * kNx),
                iy = static_cast<int>(random.uniform() * kNy);
      const double number = random.uniform();
      table_.at(ix, iy).number = number;
      map_.values[static_cast<std::int64_t>(iy) * kNx + ix].number = number;
    }
  }

  ColumnTable<Value> table_{kNx, kNy};
  Map map_;
};

TEST_F(ColumnTables, HoldTheSameAsAMap) {
  EXPECT_EQ(table_.size(), map_.values.size());
  for (int iy = 0; iy < kNy; ++iy)
    for (int ix = 0; ix < kNx; ++ix) {
      const auto found = map_.values.find(static_cast<std::int64_t>(iy) * kNx + ix);
      const Value* value = table_.find(ix, iy);
      ASSERT_EQ(value != nullptr, found != map_.values.end()) << ix << " " << iy;
      if (value != nullptr) EXPECT_EQ(value->number, found->second.number) << ix << " " << iy;
    }
}

TEST_F(ColumnTables, AreHashedAndSavedLikeAMap) {
  EXPECT_EQ(hash_of(table_).digest(), hash_of(map_).digest());
  EXPECT_EQ(saved(table_), saved(map_));
}

TEST_F(ColumnTables, AreLoadedAsTheyWereSaved) {
  ColumnTable<Value> again(kNx, kNy);
  again.at(3, 3).number = 5;  // is overwritten by the load
  load_saved(saved(table_), again);
  EXPECT_EQ(saved(again), saved(table_));
  EXPECT_EQ(test::flip_every_byte(table_, again), "");
}

TEST_F(ColumnTables, RefuseColumnsOutsideTheSite) {
  ColumnTable<Value> smaller(kNx, kNy - 1);
  EXPECT_THROW(load_saved(saved(table_), smaller), InputError);
}

}  // namespace
}  // namespace navvy::coupling
