// SPDX-License-Identifier: Apache-2.0
#include "core/archive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <variant>

#include "core/error.h"
#include "core/random.h"
#include "core/saved_state.h"
#include "flip_bytes.h"

namespace navvy {
namespace {

/// A struct that lists its fields by a free function, like one of another module.
struct Rut {
  double pressure = 0, height = 0;
  bool operator==(const Rut&) const = default;
};
void visit(Archive& a, Rut& rut) {
  a("pressure", rut.pressure);
  a("height", rut.height);
}

/// Three floats without gaps.
struct Grain {
  float x = 0, y = 0, z = 0;
  bool operator==(const Grain&) const = default;
};
static_assert(sizeof(Grain) == 12);

}  // namespace

template <>
inline constexpr bool kPlain<Grain> = true;

namespace {

enum class Phase : int { kIdle, kDig, kDump };

/// A class with one field of every kind.
class Machine {
 public:
  void visit(Archive& a) {
    a.constant("joints", commanded.size(),
               "the machine has another number of joints than the scene's");
    a.section("machine", 3, [&] {
      a("steps", steps);
      a("running", running);
      a.ranged("phase", phase, Phase::kIdle, Phase::kDump);
      a.ranged("share", share, 0, 1);
      a("name", name);
      a("p_WB", p_WB);
      a("turn", turn);
      a("X_WB", X_WB);
      a("grains", grains);
      a("ruts", ruts);
      a("by_column", by_column);
      a("pending", pending);
      a("open", open);
      a("flags", flags);
      a("loads", loads);
      a.fixed("commanded", commanded);
      a("activity", activity);
      a("random", random);
      a.property(
          "radius", [&] { return radius_; }, [&](double r) { radius_ = r; });
      a.unhashed("depends on how the work was distributed", [&] { a("seconds", seconds); });
      a.section("inner", 1, [&] { a("depth", depth); });
      a.require(depth < 100, "depth", "must be below 100 m");
    });
    if (a.loading()) area_ = radius_ * radius_;
  }
  std::uint64_t steps = 7;
  bool running = true;
  Phase phase = Phase::kDig;
  double share = 0.5;
  std::string name = "ew180";
  Vec3 p_WB = Vec3(1, 2, 3);
  Eigen::Quaterniond turn = Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5);
  Pose X_WB = make_pose(1, 2, 3, 0.1, 0.2, 0.3);
  std::vector<Grain> grains = {{1, 2, 3}, {4, 5, 6}};
  std::vector<Rut> ruts = {{1, 2}};
  std::map<std::pair<int, int>, Rut> by_column = {{{1, 2}, {3, 4}}, {{1, 3}, {5, 6}}};
  std::set<int> pending = {3, 5, 8};
  std::optional<Rut> open = Rut{1, 2};
  std::array<bool, 3> flags = {true, false, true};
  std::vector<std::optional<double>> loads = {1.5, std::nullopt};
  std::vector<double> commanded = {0, 0};
  std::variant<Rut, double> activity = 0.5;
  Random random{42};
  double seconds = 12, depth = 1;
  double radius() const { return radius_; }
  void set_radius(double r) {
    radius_ = r;
    area_ = r * r;
  }
  double area() const { return area_; }

 private:
  double radius_ = 2, area_ = 4;
};

Machine changed() {
  Machine m;
  m.steps = 8;
  m.running = false;
  m.phase = Phase::kDump;
  m.share = 0.25;
  m.name = "";
  m.p_WB = Vec3(9, -0.0, 7);
  m.turn.setIdentity();
  m.X_WB = make_pose(0, -1, 0, 1, 1, 1);
  m.grains.push_back({7, 8, 9});
  m.ruts.clear();
  m.by_column.erase({1, 2});
  m.pending.insert(4);
  m.open.reset();
  m.flags[1] = true;
  m.loads = {std::nullopt, 2.5, 3.5};
  m.commanded = {1, -1};
  m.activity = Rut{8, 9};
  m.random.next();
  m.seconds = 13;
  m.depth = 99;
  m.set_radius(3);
  return m;
}

std::string fault_of(const std::vector<char>& bytes) {
  Machine machine;
  try {
    load_saved(bytes, machine);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no fault";
}

/// Returns the saved bytes of a machine with `value` written over the beginning of the field at
/// that path.
template <class T>
std::vector<char> overwritten(const std::string& path, const T& value) {
  ByteMap map;
  std::vector<char> bytes = saved(Machine(), &map);
  for (const ByteMap::Field& field : map.fields)
    if (field.path == path) {
      std::memcpy(bytes.data() + field.offset, &value, sizeof value);
      return bytes;
    }
  ADD_FAILURE() << "no field " << path;
  return bytes;
}

TEST(Archive, LoadsSavedFieldsAndRebuildsDerivedOnes) {
  const Machine from = changed();
  Machine to;
  load_saved(saved(from), to);
  EXPECT_EQ(to.steps, 8u);
  EXPECT_FALSE(to.running);
  EXPECT_EQ(to.phase, Phase::kDump);
  EXPECT_EQ(to.share, 0.25);
  EXPECT_EQ(to.name, "");
  EXPECT_EQ(to.p_WB, from.p_WB);
  EXPECT_TRUE(std::signbit(to.p_WB.y())) << "compared by bits, not by values";
  EXPECT_EQ(to.turn.coeffs(), from.turn.coeffs());
  EXPECT_EQ(to.X_WB.matrix(), from.X_WB.matrix());
  EXPECT_EQ(to.grains, from.grains);
  EXPECT_EQ(to.ruts, from.ruts);
  EXPECT_EQ(to.by_column, from.by_column);
  EXPECT_EQ(to.pending, from.pending);
  EXPECT_EQ(to.open, from.open);
  EXPECT_EQ(to.flags, from.flags);
  EXPECT_EQ(to.loads, from.loads);
  EXPECT_EQ(to.commanded, from.commanded);
  EXPECT_EQ(to.activity, from.activity);
  EXPECT_EQ(to.seconds, 13);
  EXPECT_EQ(to.radius(), 3);
  EXPECT_EQ(to.area(), 9);
  Random random = from.random, loaded = to.random;
  EXPECT_EQ(loaded.next(), random.next());
  EXPECT_EQ(saved(to), saved(from));
  EXPECT_EQ(hash_of(to).digest(), hash_of(from).digest());
}

TEST(Archive, HashesEverySavedByteExceptFieldsThatGiveAReason) {
  const Machine machine;
  Machine target;
  EXPECT_EQ(test::flip_every_byte(machine, target), "");
}

TEST(Archive, HashesLengthsSoThatElementsCannotMoveToAnotherList) {
  Machine a, b;
  a.name = "ab";
  b.name = "a";
  b.p_WB = a.p_WB;
  EXPECT_NE(hash_of(a).digest(), hash_of(b).digest());
  a = b = Machine();
  a.open = Rut{};
  b.open = std::nullopt;
  EXPECT_NE(hash_of(a).digest(), hash_of(b).digest());
}

TEST(Archive, OmitsOnlyMarkedFieldsFromTheHash) {
  Machine a, b;
  b.seconds = 1000;
  EXPECT_EQ(hash_of(a).digest(), hash_of(b).digest());
  EXPECT_NE(saved(a), saved(b));
  ByteMap map;
  saved(a, &map);
  std::vector<std::string> silent;
  for (const ByteMap::Field& field : map.fields)
    if (!field.hashed) silent.push_back(field.path + ": " + field.reason);
  EXPECT_EQ(silent, (std::vector<std::string>{
                        "joints: ", "machine/seconds: depends on how the work was distributed"}));
}

TEST(Archive, NamesTheFieldOfEveryByte) {
  ByteMap map;
  const std::vector<char> bytes = saved(Machine(), &map);
  EXPECT_EQ(map.at(0)->path, "joints");
  EXPECT_EQ(map.at(8), nullptr) << "the head of the section";
  EXPECT_EQ(map.at(8 + 28)->path, "machine/steps");
  std::size_t end = 0, heads = 0;
  bool rut = false;
  for (const ByteMap::Field& field : map.fields) {
    EXPECT_GE(field.offset, end);
    heads += field.offset - end;
    end = field.offset + field.size;
    rut = rut || field.path == "machine/by_column[1]/height";
  }
  EXPECT_EQ(end, bytes.size());
  EXPECT_EQ(heads, 2u * 28) << "of two sections: tag, version, size";
  EXPECT_TRUE(rut);
  EXPECT_EQ(map.at(bytes.size()), nullptr);
}

TEST(Archive, RefusesTruncatedAndOverlongStates) {
  const std::vector<char> whole = saved(Machine());
  for (std::size_t n = 0; n < whole.size(); ++n)
    EXPECT_NE(fault_of({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n)}), "no fault")
        << "cut at " << n;
  std::vector<char> longer = whole;
  longer.push_back(0);
  EXPECT_NE(fault_of(longer).find("is longer"), std::string::npos) << fault_of(longer);
}

TEST(Archive, RefusesLengthsBeyondTheEndBeforeItAllocates) {
  for (const char* path :
       {"machine/name", "machine/grains", "machine/ruts", "machine/by_column", "machine/pending"})
    for (const std::uint64_t n :
         {std::uint64_t{1} << 62, ~std::uint64_t{0}, std::uint64_t{100000}}) {
      const std::string fault = fault_of(overwritten(path, n));
      EXPECT_NE(fault.find(path), std::string::npos) << fault;
      EXPECT_NE(fault.find("length"), std::string::npos) << fault;
    }
  // A length that the bytes allow but the elements do not: detected element by element, without
  // allocating for all.
  EXPECT_NE(fault_of(overwritten("machine/ruts", std::uint64_t{300})), "no fault");
}

TEST(Archive, NamesTheFieldThatIsOutOfItsRange) {
  const auto says = [](const std::string& fault, const std::string& text) {
    EXPECT_NE(fault.find(text), std::string::npos) << fault;
  };
  says(fault_of(overwritten("machine/running", char{2})), "machine/running: must be 0 or 1");
  says(fault_of(overwritten("machine/flags[1]", char{7})), "machine/flags[1]");
  says(fault_of(overwritten("machine/phase", 3)), "machine/phase");
  says(fault_of(overwritten("machine/phase", -1)), "machine/phase");
  says(fault_of(overwritten("machine/activity", 2u)), "machine/activity");
  says(fault_of(overwritten("machine/share", 1.5)), "machine/share");
  says(fault_of(overwritten("machine/share", std::numeric_limits<double>::quiet_NaN())),
       "machine/share");
  // A rotation that stretches: the bounding box of a body would get an arbitrary size.
  says(fault_of(overwritten("machine/X_WB", 2.0)), "machine/X_WB: must be a finite rigid pose");
  says(fault_of(overwritten("machine/X_WB", std::numeric_limits<double>::infinity())),
       "machine/X_WB: must be a finite");
  says(fault_of(overwritten("machine/inner/depth", 100.0)), "machine/depth: must be below 100 m");
  says(fault_of(overwritten("machine/commanded", std::uint64_t{1})), "machine/commanded");
  says(fault_of(overwritten("joints", std::uint64_t{5})), "another number of joints");
  says(fault_of(overwritten("machine/pending[1]", 3)),
       "machine/pending[1]: keys must be in ascending order");
  says(fault_of(overwritten("machine/by_column[1]", 0)), "machine/by_column[1]");
}

TEST(Archive, RefusesAnotherSectionAndAnotherVersion) {
  struct Other {
    const char* tag;
    std::uint32_t version;
    int value = 0;
    void visit(Archive& a) {
      a.section(tag, version, [&] { a("value", value); });
    }
  };
  const std::vector<char> bytes = saved(Other{"soil", 2});
  for (Other other : {Other{"ground", 2}, Other{"soil", 1}, Other{"soil", 3}, Other{"soi", 2}})
    EXPECT_THROW(load_saved(bytes, other), InputError) << other.tag << other.version;
  Other same{"soil", 2};
  EXPECT_NO_THROW(load_saved(bytes, same));
  EXPECT_THROW(saved(Other{"a tag that is too long", 1}), Error);
  EXPECT_THROW(saved(Other{"", 1}), Error);
}

TEST(Archive, RefusesSectionsThatAreLeftOver) {
  struct Part {
    int value = 0;
    void visit(Archive& a) {
      a.section("part", 1, [&] { a("value", value); });
    }
  };
  struct Whole {
    Part first{1}, second{2};
    void visit(Archive& a) {
      a("first", first);
      a("second", second);
    }
  };
  Part front;
  EXPECT_THROW(load_saved(saved(Whole()), front), InputError);
}

TEST(Archive, RefusesASectionThatIsShorterOrLongerThanItsVisit) {
  struct Long {
    int n = 2, a = 1, b = 2;
    void visit(Archive& archive) {
      archive.section("pair", 1, [&] {
        archive("a", a);
        if (n > 1) archive("b", b);
      });
    }
  };
  Long two, one;
  one.n = 1;
  EXPECT_THROW(load_saved(saved(two), one), InputError);
  EXPECT_THROW(load_saved(saved(one), two), InputError);
}

TEST(Archive, VisitsUserContainersElementByElement) {
  /// A container outside the standard library, here a ring buffer.
  struct Ring {
    std::array<int, 4> slots = {1, 2, 3, 4};
    std::uint64_t used = 3;
    void visit(Archive& a) {
      used = a.size("used", used);
      a.require(used <= 4, "used", "a ring holds four");
      for (std::uint64_t i = 0; i < used; ++i) a.item(i, [&] { a("value", slots[i]); });
    }
  };
  Ring from, to;
  from.slots = {5, 6, 7, 8};
  to.used = 1;
  load_saved(saved(from), to);
  EXPECT_EQ(to.used, 3u);
  EXPECT_EQ(to.slots, (std::array<int, 4>{5, 6, 7, 4}));
  from.used = 4;
  std::vector<char> bytes = saved(from);
  bytes[0] = 5;
  bytes.resize(bytes.size() + 4);
  EXPECT_THROW(load_saved(bytes, to), InputError);
}

TEST(Archive, PassesThroughVirtualInterfaces) {
  struct Engine {
    virtual ~Engine() = default;
    virtual void visit(Archive& a) = 0;
  };
  struct Spring final : Engine {
    double length = 1;
    void visit(Archive& a) override { a("length", length); }
  };
  Spring from, to;
  from.length = 3;
  const Engine& engine = from;
  Engine& other = to;
  load_saved(saved(engine), other);
  EXPECT_EQ(to.length, 3);
}

/// Saves a field that the hash omits: the mistake that flipping every byte detects.
TEST(FlipEveryByte, FindsAFieldThatIsSavedAndNotHashed) {
  struct Forgetful {
    int a = 1, b = 2;
    void visit(Archive& archive) {
      archive("a", a);
      int copy = b;
      archive("b", copy);  // never loaded back
    }
  };
  const Forgetful object;
  Forgetful target;
  EXPECT_EQ(test::flip_every_byte(object, target), "b: is saved but not hashed\n");
}

/// A view of data stored elsewhere.
struct Window {
  std::span<const float> seen;
  void visit(Archive& a) { a("values", seen); }
};
struct Values {
  std::vector<float> values;
  void visit(Archive& a) { a("values", values); }
};

TEST(Archive, TreatsAViewLikeItsVector) {
  const Values from{{1, 2.5f, -3}};
  Window window{from.values};
  EXPECT_EQ(saved(window), saved(from));
  EXPECT_EQ(hash_of(window).digest(), hash_of(from).digest());
  Values to;
  load_saved(saved(window), to);
  EXPECT_EQ(to.values, from.values);
  EXPECT_THROW(load_saved(saved(from), window), InputError) << "the viewed data is not modified";
}

}  // namespace
}  // namespace navvy
