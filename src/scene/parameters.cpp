// SPDX-License-Identifier: Apache-2.0
#include "scene/parameters.h"

#include <set>
#include <string_view>
#include <utility>

namespace navvy::scene {
namespace {

/// Writes the parameters of a scene under a path.
class Writer final : public Fields {
 public:
  Writer(Parameters& out, std::string path) : out_(out), path_(std::move(path)) {}

  void field(const Field& f) override {
    if (f.mark.has(Mark::kShown) || (f.mark.given != nullptr && !*f.mark.given)) return;
    // value_text has no text for a pose. The matrix restores the rotation exactly; angles would
    // not.
    if (Pose* const* pose = std::get_if<Pose*>(&f.value)) {
      Vec3 place = (*pose)->translation();
      Mat3 turn = (*pose)->linear();
      put(f.name + std::string("/place"), value_text(&place, 1));
      put(f.name + std::string("/turn"), value_text(&turn, 1));
    } else {
      put(f.name, value_text(f.value, unit_of(f.name).factor));
    }
  }
  void group(const Group& g, const std::function<void(Fields&)>& describe) override {
    // An element that is not given has no parameters: its members are defaults without a meaning.
    if (g.mark.has(Mark::kShown) || !g.present || (g.mark.given != nullptr && !*g.mark.given))
      return;
    Writer inner(out_, path_ + plain(g.name) + "/");
    describe(inner);
  }
  void list(const List& list) override {
    if (list.mark.has(Mark::kShown)) return;
    std::set<std::string> keys;
    for (std::size_t i = 0; i < list.size; ++i) {
      // Items with a name go by it, so that a message names the soil or machine that differs.
      std::string key = name_of([&](Fields& f) { list.item(i, f); });
      // Items may share a name, such as two layers of one soil; the number keeps their paths apart.
      if (key.empty() || !keys.insert(key).second) key = std::to_string(i + 1);
      Writer inner(out_, path_ + plain(list.name) + "[" + key + "]/");
      list.item(i, inner);
      // The state counts soils, machines, joints and bodies by number, so their order matters.
      inner.put("number", std::to_string(i + 1));
    }
  }
  void types(const Types& types) override {
    put(types.attribute, types.names.at(types.index));
    types.describe(types.index, *this);
  }
  void elsewhere(const std::function<void(Fields&)>& describe) override { describe(*this); }

 private:
  static std::string plain(std::string_view name) {
    if (name.starts_with("navvy:")) name.remove_prefix(6);
    return std::string(name);
  }
  void put(std::string_view name, const std::string& value) { out_[path_ + plain(name)] = value; }

  Parameters& out_;
  std::string path_;
};

}  // namespace

Parameters parameters(const Scene& scene) {
  Parameters out;
  Writer writer(out, "");
  // `describe` is not const because readers write to the fields; this visitor only reads.
  const_cast<Scene&>(scene).describe(writer);
  return out;
}

std::string differences(const Parameters& before, const Parameters& now, int most) {
  std::string out;
  int found = 0;
  const auto add = [&](const std::string& path, const std::string& was, const std::string& is) {
    if (++found <= most) out += (out.empty() ? "" : "; ") + path + ": " + was + ", here " + is;
  };
  const auto quoted = [](const std::string& text) {
    // Long texts, such as polygons, are cut: the message is to name the place.
    return "'" + (text.size() <= 60 ? text : text.substr(0, 60) + "...") + "'";
  };
  for (const auto& [path, value] : before) {
    const auto other = now.find(path);
    if (other == now.end())
      add(path, quoted(value), "nothing");
    else if (other->second != value)
      add(path, quoted(value), quoted(other->second));
  }
  for (const auto& [path, value] : now)
    if (before.count(path) == 0) add(path, "nothing", quoted(value));
  if (found > most) out += "; and " + std::to_string(found - most) + " more";
  return out;
}

}  // namespace navvy::scene
