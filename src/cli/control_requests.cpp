// SPDX-License-Identifier: Apache-2.0
#include "cli/control_requests.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/edit_distance.h"
#include "core/error.h"
#include "core/file.h"
#include "core/saved_state.h"
#include "core/sealed.h"
#include "map/map_queries.h"
#include "map/map_sources.h"
#include "sim/world_terrain.h"

namespace navvy::cli {

using nlohmann::json;

namespace {

constexpr const char* kRequests[] = {"heights", "changed", "image", "info",
                                     "reset",   "save",    "load",  "watch"};
/// A million numbers are 10 MB of JSON.
constexpr double kMostCells = 1e6;

[[noreturn]] void refuse(const std::string& key, const json& value, const std::string& rule,
                         const std::string& remedy) {
  throw InputError(Fault{Fault::Severity::kError, "", 0, key, shown(value), rule, remedy});
}

double number_in(const std::string& key, const json& value, double least, double most) {
  if (!value.is_number() || !(value.get<double>() >= least) || !(value.get<double>() <= most))
    refuse(key, value, "must be a number from " + shown(json(least)) + " to " + shown(json(most)),
           "mend it");
  return value.get<double>();
}

std::string text_in(const std::string& key, const json& value) {
  if (!value.is_string() || value.get<std::string>().empty() ||
      value.get<std::string>().size() > 1000)
    refuse(key, value, "must be a text of 1 to 1000 bytes", "e.g. {\"" + key + "\": \"name\"}");
  return value.get<std::string>();
}

void must_be_true(const std::string& key, const json& value) {
  if (value != json(true)) refuse(key, value, "must be true", "send {\"" + key + "\": true}");
}

/// A controller's slip costs no script or map: what is there and holds something must be a
/// snapshot.
void require_snapshot_or_nothing(const json& what, const std::string& path) {
  std::error_code code;
  if (is_sealed(path) || !std::filesystem::is_regular_file(path, code) ||
      std::filesystem::file_size(path, code) == 0)
    return;
  refuse("save", what, "is there and is no snapshot, so it stays",
         "name a new file, or remove this one");
}

/// As a PNG goes into a line of text [RFC 4648].
std::string base64(const std::vector<char>& bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (int k = 3; k >= 0; --k) out += kDigits[three >> (6 * k) & 63u];
  }
  for (std::size_t k = 0; k < (3 - bytes.size() % 3) % 3; ++k) out[out.size() - 1 - k] = '=';
  return out;
}

}  // namespace

std::string shown(const std::string& text) {
  std::string out = text.size() <= 80 ? text : text.substr(0, 80) + "...";
  // A NUL would end the message that holds it.
  for (char& c : out)
    if (static_cast<unsigned char>(c) < 0x20) c = '?';
  return out;
}

std::string shown(const json& value) {
  return shown(value.dump(-1, ' ', false, json::error_handler_t::replace));
}

ControlRequests::ControlRequests(session::Session& session, double rate, ControlServices services)
    : session_(session),
      world_(session.world()),
      rate_(rate),
      services_(std::move(services)),
      start_(saved(session)),
      feed_(map::options_for(session.world().description(), session.world().ground(),
                             map::all_layers(), session.design())) {
  // What changes before the first question is known to have changed.
  now();
}

bool ControlRequests::is_request(const json& line) {
  return line.is_object() && std::any_of(std::begin(kRequests), std::end(kRequests),
                                         [&](const char* key) { return line.contains(key); });
}

map::UpdateFeed::Update ControlRequests::now() {
  return feed_.publish(sim::terrain_view(world_, heightfield::SurfaceKind::kMapped));
}

json ControlRequests::answer(const json& line) {
  moved_ = false;
  const std::string key = line.begin().key();
  if (line.size() != 1)
    refuse(key, line, "a line asks for one thing and drives nothing", "send two lines");
  const json& what = line.begin().value();
  json out;
  if (key == "heights") out = heights(what);
  if (key == "changed") out = changed(what);
  if (key == "image") out = image(what);
  if (key == "info") {
    must_be_true(key, what);
    out = info();
  }
  if (key == "reset") {
    must_be_true(key, what);
    out = go_back([&] { load_saved(start_, session_); });
  }
  const bool file = key == "save" || key == "load";
  if (file && !services_.files) refuse(key, what, "files are not to be had here", "use reset");
  if (key == "watch") {
    const std::size_t before = world_.outputs().size();
    session_.watch(text_in(key, what));
    out = json::object();
    for (std::size_t i = before; i < world_.outputs().size(); ++i)
      out[world_.outputs()[i].name] = world_.outputs()[i].unit;
  }
  if (key == "save") {
    const std::string path = text_in(key, what);
    require_snapshot_or_nothing(what, path);
    session_.save(path);
    out = {{"file", path}, {"time", world_.time()}};
  }
  if (key == "load") {
    const std::string path = text_in(key, what);
    out = go_back([&] { session_.load(path); });
    out["file"] = path;
  }
  return {{key, out}};
}

/// What fails half way leaves a state that is none: the one before comes back.
json ControlRequests::go_back(const std::function<void()>& load) {
  const std::vector<char> before = saved(session_);
  try {
    load();
  } catch (...) {
    load_saved(before, session_);
    throw;
  }
  moved_ = true;
  // Of what was before this state the map knows nothing.
  feed_.restart();
  now();
  return {{"time", world_.time()}, {"steps", world_.steps()}};
}

/// {"min_m": [x, y], "max_m": [x, y], "cell_m": 0.2, "layer": "slope"}: heights are bilinear at the
/// cells' centres, other layers are those of the columns that hold them.
json ControlRequests::heights(const json& what) {
  if (!what.is_object())
    refuse("heights", what, "must be an object",
           R"({"min_m": [0, 0], "max_m": [2, 1], "cell_m": 0.2})");
  const map::UpdateFeed::Update newest = now();
  const map::TerrainMap& map = newest->map;
  Vec2 low = map.origin(), high = low + map.cell() * Vec2(map.nx(), map.ny());
  double cell = map.cell();
  map::MapLayer layer = map::MapLayer::kElevation;
  for (const auto& [key, value] : what.items()) {
    const std::string name = "heights/" + key;
    if (key == "cell_m") {
      cell = number_in(name, value, 1e-3, 1e4);
    } else if (key == "layer") {
      layer = map::layer_named(text_in(name, value));
    } else if (key == "min_m" || key == "max_m") {
      if (!value.is_array() || value.size() != 2)
        refuse(name, value, "must be [x, y]", "two numbers in metres");
      Vec2& corner = key == "min_m" ? low : high;
      corner = Vec2(number_in(name, value[0], -1e7, 1e7), number_in(name, value[1], -1e7, 1e7));
    } else {
      refuse(name, value, "is none of min_m, max_m, cell_m, layer",
             suggestion(key, {"min_m", "max_m", "cell_m", "layer"}));
    }
  }
  // A rectangle that is a whole number of cells but for rounding is not given one more.
  const Vec2 cells = ((high - low) / cell - Vec2::Constant(1e-6)).array().ceil().matrix();
  if (!((high - low).array() > 0).all() || cells.x() * cells.y() > kMostCells)
    refuse("heights", what, "must be a rectangle of 1 to 1000000 cells",
           "max_m above min_m, or a larger cell_m");
  const int nx = std::max(1, static_cast<int>(cells.x())),
            ny = std::max(1, static_cast<int>(cells.y()));
  json values = json::array();
  for (int iy = 0; iy < ny; ++iy)
    for (int ix = 0; ix < nx; ++ix) {
      const Vec2 p = low + cell * Vec2(ix + 0.5, iy + 0.5);
      const double v = layer == map::MapLayer::kElevation
                           ? map::height(map, p.x(), p.y())
                           : static_cast<double>(map::value(map, layer, p.x(), p.y()));
      // JSON knows no NaN.
      values.push_back(v == v ? json(v) : json(nullptr));
    }
  return {{"layer", map::info(layer).name},
          {"unit", map::info(layer).unit},
          {"min_m", {low.x(), low.y()}},
          {"cell_m", cell},
          {"nx", nx},
          {"ny", ny},
          {"sequence", newest->sequence},
          {"map_time", newest->time},
          {"time", world_.time()},
          {"values", values}};
}

json ControlRequests::changed(const json& what) {
  if (!what.is_number_unsigned())
    refuse("changed", what, "must be a whole number", "0, or the sequence of the last answer");
  const map::UpdateFeed::Update newest = now();
  const map::UpdateFeed::Update update = feed_.since(what.get<std::uint64_t>());
  json out = {{"since", what},
              {"sequence", newest->sequence},
              {"map_time", newest->time},
              {"time", world_.time()},
              {"columns", 0},
              {"merged", false},
              {"rects_m", json::array()}};
  if (update == nullptr) return out;
  const map::TerrainMap& map = update->map;
  for (const heightfield::CellRect& r : update->rects) {
    const Vec2 low = map.origin() + map.cell() * Vec2(r.x0, r.y0),
               high = map.origin() + map.cell() * Vec2(r.x1, r.y1);
    out["rects_m"].push_back({low.x(), low.y(), high.x(), high.y()});
  }
  out["since"] = update->since;
  out["columns"] = update->changed;
  out["merged"] = update->merged;
  return out;
}

json ControlRequests::image(const json& what) const {
  const std::string name = text_in("image", what);
  std::vector<std::string> names;
  for (const scene::Camera& camera : world_.description().cameras) names.push_back(camera.name);
  if (std::find(names.begin(), names.end(), name) == names.end())
    refuse("image", what, "no camera of this name in the scene",
           names.empty() ? "add a <navvy:camera>" : suggestion(name, names));
  if (!services_.draw) refuse("image", what, "nobody draws here", "ask the program navvy");
  const Picture picture = services_.draw(name);
  return {{"camera", name},
          {"time", world_.time()},
          {"width", picture.width},
          {"height", picture.height},
          {"png_base64", base64(picture.png)}};
}

json ControlRequests::info() const {
  const heightfield::Ground& ground = world_.ground();
  const auto units = [](const std::vector<sim::Channel>& channels) {
    json out = json::object();
    for (const sim::Channel& channel : channels) out[channel.name] = channel.unit;
    return out;
  };
  json layers = json::object(), cameras = json::array();
  for (const map::LayerInfo& each : map::layers()) layers[each.name] = each.unit;
  for (const scene::Camera& camera : world_.description().cameras) cameras.push_back(camera.name);
  return {{"scene", world_.description().name},
          {"device", session_.device_name()},
          {"time", world_.time()},
          {"step_s", world_.dt()},
          {"control_rate_hz", rate_},
          {"site",
           {{"origin_m", {ground.origin().x(), ground.origin().y()}},
            {"cell_m", ground.cell()},
            {"nx", ground.nx()},
            {"ny", ground.ny()}}},
          {"inputs", units(world_.inputs().channels())},
          {"outputs", units(world_.outputs().channels())},
          {"layers", layers},
          {"cameras", cameras}};
}

}  // namespace navvy::cli
