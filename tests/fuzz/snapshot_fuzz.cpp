// SPDX-License-Identifier: Apache-2.0
// Edits a valid state, updates its checksums, loads it from a file and runs three steps. An input
// is a list of edits of 16 bytes each. An edit first selects a kind of field (its name without
// numbers) and then a field, since most bytes of a state are alike.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "control/step_kinds.h"
#include "core/error.h"
#include "core/saved_state.h"
#include "core/sealed.h"
#include "device/device.h"
#include "scene_io/loader.h"
#include "session/session.h"
#include "sim/snapshot.h"
#include "target.h"

namespace {

using namespace navvy;

// The smallest scene with all kinds of parts: a bucket in the soil, and a dumper with a load that
// drives.
const char* const kScene =
    R"(<sdf version="1.9" xmlns:navvy="navvy"><world name="w"><navvy:soil ref="loam"/>
<navvy:ground><size_m>12 6</size_m><depth_m>1</depth_m></navvy:ground>
<navvy:solver><cell_m>0.3</cell_m><max_particles>20000</max_particles></navvy:solver>
<include><uri>model://test_bucket</uri><name>bucket</name><pose>-4 0 0 0 0 0</pose>
<navvy:on_ground>false</navvy:on_ground><navvy:joint name="slide_z"><initial_m>0.3</initial_m></navvy:joint>
<navvy:joint name="curl"><initial_deg>-70</initial_deg></navvy:joint><navvy:program><trajectory><times_s>0 1</times_s>
<joint name="slide_x"><positions_m>0 0.5</positions_m></joint>
<joint name="slide_z"><positions_m>0.3 -0.3</positions_m></joint></trajectory></navvy:program></include>
<include><uri>model://dumper</uri><name>truck</name><pose>0 0 0 0 0 0</pose>
<navvy:load><mass_kg>300</mass_kg></navvy:load>
<navvy:program><drive_to><target_m>3 0</target_m></drive_to></navvy:program></include></world></sdf>)";

// Time of the state [s]: soil is active, and each program has begun.
constexpr double kBefore = 0.2;
constexpr std::size_t kEdit = 16, kMostEdits = 8;

/// Content of a snapshot's file behind its seal.
struct Content {
  sim::SnapshotStart start;
  session::Session& session;
  void visit(Archive& a) {
    a("start", start);
    a("session", session);
  }
};

struct Place {
  // [bytes]
  std::size_t offset = 0, size = 0;
};

/// A valid state, its fields by names without numbers, and the session that loads the edited
/// states.
struct Crafted {
  device::Device device;
  session::Session session{
      scene_io::load_scene_from_string(kScene, "fuzz/scene.sdf", control::step_kinds()), device};
  std::vector<char> state;
  std::vector<std::vector<Place>> kinds;
  // Offsets of the heads of sections.
  std::vector<std::size_t> heads;
  int file = ::memfd_create("snapshot", 0);
  std::string path = "/proc/self/fd/" + std::to_string(file);

  Crafted() {
    while (session.world().time() < kBefore) session.step();
    ByteMap map;
    state = saved(Content{{session.world().start(), session.world().description().name}, session},
                  &map);
    std::map<std::string, std::vector<Place>> by_name;
    std::size_t end = 0;
    for (const ByteMap::Field& field : map.fields) {
      // Only heads of sections lie between fields.
      for (; end + kSectionHead <= field.offset; end += kSectionHead) {
        heads.push_back(end);
        by_name["head"].push_back({end, kSectionHead - sizeof(std::uint64_t)});
      }
      end = field.offset + field.size;
      std::string name = field.path;
      name.erase(
          std::remove_if(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; }),
          name.end());
      if (field.size > 0) by_name[name].push_back({field.offset, field.size});
    }
    for (auto& [name, places] : by_name) kinds.push_back(std::move(places));
  }
};

template <class T>
void put(const T& value, char* to, std::size_t size) {
  if (sizeof value == size) std::memcpy(to, &value, size);
}

/// Writes a value that no run writes to a number of `size` bytes.
void put_extreme(unsigned which, char* to, std::size_t size) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const float floats[] = {std::nanf(""), kInf, -kInf, 1e30f, -1e30f, 1e-40f, 0, 1};
  const std::int32_t ints[] = {-1, 1, 1000, 1 << 20, 2147483647, -2147483647 - 1, 0, 2};
  const double doubles[] = {std::nan(""), kInf, -kInf, 1e300, -1e300, 1e-310, 0, 1};
  const std::int64_t longs[] = {
      -1, 1, std::int64_t{1} << 40, INT64_MAX, INT64_MIN, std::int64_t{1} << 31, 0, 2};
  const bool whole = (which & 8) != 0;
  which &= 7;
  if (whole) {
    put(ints[which], to, size);
    put(longs[which], to, size);
  } else {
    put(floats[which], to, size);
    put(doubles[which], to, size);
  }
  put(static_cast<std::uint8_t>(which * 37 - 1), to, size);
}

/// Bytes that are inserted or removed; the lengths of the enclosing sections are updated.
struct Resize {
  Place place;
  bool grow = false;
};

void apply(const Crafted& crafted, std::vector<Resize> resizes, std::vector<char>& state) {
  for (const Resize& resize : resizes)
    for (const std::size_t head : crafted.heads) {
      char* const at = state.data() + head + kSectionHead - sizeof(std::uint64_t);
      std::uint64_t length = 0, before = 0;
      std::memcpy(&length, at, sizeof length);
      std::memcpy(&before, crafted.state.data() + (at - state.data()), sizeof before);
      const std::size_t body = head + kSectionHead;
      if (resize.place.offset < body || resize.place.offset >= body + before) continue;
      length = resize.grow ? length + resize.place.size : length - resize.place.size;
      std::memcpy(at, &length, sizeof length);
    }
  // Starts from the back, so that the offsets in front stay valid.
  std::sort(resizes.begin(), resizes.end(),
            [](const Resize& a, const Resize& b) { return a.place.offset > b.place.offset; });
  std::size_t last = state.size();
  for (const Resize& resize : resizes) {
    const auto begin = state.begin() + static_cast<std::ptrdiff_t>(resize.place.offset);
    const auto end = begin + static_cast<std::ptrdiff_t>(resize.place.size);
    if (resize.place.offset + resize.place.size > last) continue;
    last = resize.place.offset;
    if (resize.grow) {
      const std::vector<char> copy(begin, end);
      state.insert(end, copy.begin(), copy.end());
    } else {
      state.erase(begin, end);
    }
  }
}

std::vector<char> edited(const Crafted& crafted, const std::uint8_t* data, std::size_t size) {
  std::vector<char> state = crafted.state;
  std::vector<Resize> resizes;
  for (std::size_t n = 0; n < kMostEdits && (n + 1) * kEdit <= size; ++n) {
    const std::uint8_t* const edit = data + n * kEdit;
    const auto& places = crafted.kinds[(edit[0] + 256u * edit[1]) % crafted.kinds.size()];
    const Place field = places[(edit[2] + 256u * edit[3]) % places.size()];
    const std::size_t width = field.size % 8 == 0 ? 8 : field.size % 4 == 0 ? 4 : 1;
    const std::size_t within = (edit[5] + 256u * edit[6]) % (field.size / width) * width;
    char* const to = state.data() + field.offset + within;
    switch (edit[4] % 7) {
      case 0:
        std::memcpy(to, edit + 8, width);
        break;
      case 1:
        to[edit[9] % width] ^= static_cast<char>(1 << (edit[8] % 8));
        break;
      case 2: {
        const Place other = places[(edit[8] + 256u * edit[9]) % places.size()];
        std::memcpy(to, crafted.state.data() + other.offset,
                    std::min(field.size - within, other.size));
        break;
      }
      case 3:
        resizes.push_back(
            {{field.offset + within, width * (1 + edit[8] % ((field.size - within) / width))},
             true});
        break;
      case 4:
        resizes.push_back(
            {{field.offset + within, width * (1 + edit[8] % ((field.size - within) / width))},
             false});
        break;
      default:
        // Runs of plain values look like 8-byte numbers, but may be 4-byte ones.
        put_extreme(edit[8], to, width == 8 && (edit[9] & 1) != 0 ? 4 : width);
    }
  }
  apply(crafted, std::move(resizes), state);
  return state;
}

/// Returns the state, which is never destroyed: threads of the driver would outlive it.
Crafted& the_one() {
  static Crafted& crafted = *new Crafted;
  return crafted;
}

}  // namespace

/// Compiles the kernels before the first input, since an empty cache would cost that input a
/// minute.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  the_one();
  return 0;
}

NAVVY_FUZZ_TARGET(snapshot) {
  Crafted& crafted = the_one();
  std::vector<char> content;
  try {
    content = seal(edited(crafted, data, size));
  } catch (const Error&) {
    // The edits broke the sections.
    return 0;
  }
  fuzz::hold(::ftruncate(crafted.file, 0) == 0);
  fuzz::hold(::pwrite(crafted.file, content.data(), content.size(), 0) ==
             static_cast<ssize_t>(content.size()));
  try {
    crafted.session.load(crafted.path, true);
    for (int i = 0; i < 3; ++i) crafted.session.step();
    crafted.session.state_hash();
  } catch (const Error&) {
    // Refused with a field's name, or the run stopped with a message.
  }
  return 0;
}
