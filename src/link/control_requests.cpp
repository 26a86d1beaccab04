// SPDX-License-Identifier: Apache-2.0
#include "link/control_requests.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>
#include <vector>

#include "core/base64.h"
#include "core/edit_distance.h"
#include "core/error.h"
#include "core/sealed.h"
#include "link/array_header.h"
#include "map/map_queries.h"
#include "map/map_sources.h"
#include "record/program_list.h"
#include "record/score.h"
#include "record/score_json.h"
#include "render/image.h"
#include "sensor/sensor_output.h"
#include "sim/read_particles.h"

namespace navvy::link {

using nlohmann::json;

namespace {

constexpr const char* kRequests[] = {"heights", "changed", "arrays",  "frames", "particles",
                                     "image",   "info",    "reset",   "save",   "load",
                                     "watch",   "order",   "progress"};
/// Maximum number of values in an answer: a million numbers are 10 MB of JSON.
constexpr double kMostCells = 1e6;
constexpr std::size_t kMaxArrays = 1000;
/// Maximum length of the steps of an order, which is a part of a line.
constexpr std::size_t kLongestOrder = 1 << 20;

/// Throws the error of a request: key, value, rule and remedy.
[[noreturn]] void refuse(const std::string& key, const json& value, const std::string& rule,
                         const std::string& remedy) {
  throw InputError(Fault{Fault::Severity::kError, "", 0, key, shown(value), rule, remedy});
}

/// Returns a number in a range. Comparisons with NaN are false, so NaN is refused.
double number_in(const std::string& key, const json& value, double least, double most) {
  if (!value.is_number() || !(value.get<double>() >= least) || !(value.get<double>() <= most))
    refuse(key, value, "must be a number from " + shown(json(least)) + " to " + shown(json(most)),
           "send a number in this range");
  return value.get<double>();
}

/// Returns a text of reasonable length; names and paths have at most 1000 bytes.
std::string text_in(const std::string& key, const json& value, std::size_t longest = 1000) {
  if (!value.is_string() || value.get<std::string>().empty() ||
      value.get<std::string>().size() > longest)
    refuse(key, value, "must be a text of 1 to " + std::to_string(longest) + " bytes",
           "e.g. {\"" + key.substr(key.rfind('/') + 1) + "\": \"name\"}");
  return value.get<std::string>();
}

void must_be_true(const std::string& key, const json& value) {
  if (value != json(true)) refuse(key, value, "must be true", "send {\"" + key + "\": true}");
}

/// Refuses to replace a file that is not a snapshot, so that a mistake of a controller destroys no
/// script or map.
void require_snapshot_or_nothing(const json& what, const std::string& path) {
  std::error_code code;
  if (is_sealed(path) || !std::filesystem::is_regular_file(path, code) ||
      std::filesystem::file_size(path, code) == 0)
    return;
  refuse("save", what, "exists and is no snapshot, so it is not replaced",
         "name a new file, or remove this one");
}

/// Returns what an array is and its latest value as text.
json value_of(const sim::ArrayView& view) {
  json out = array_header(view);
  out["data_base64"] = base64(view.bytes());
  return out;
}

/// Returns the names in a request; `true` stands for `all`.
std::vector<std::string> names_in(const std::string& key, const json& what,
                                  std::vector<std::string> all, std::size_t most) {
  if (what == json(true)) return all;
  std::vector<std::string> out;
  if (!what.is_array() || what.size() > most)
    refuse(key, what,
           "must be a list of at most " + std::to_string(most) + " names, or true for all",
           "{\"" + key + R"(": ["name"]})");
  for (const json& name : what) out.push_back(text_in(key, name));
  return out;
}

/// Returns the names of all arrays.
std::vector<std::string> names_of(const sim::ArrayOutputs& arrays) {
  std::vector<std::string> out;
  for (const sim::ArrayChannel& channel : arrays.channels()) out.push_back(channel.name);
  return out;
}

}  // namespace

// A cut inside a character is repaired where the text becomes JSON, which replaces bad UTF-8.
std::string shown(const std::string& text) {
  std::string out = text.size() <= 80 ? text : text.substr(0, 80) + "...";
  // A NUL would end the message that contains it.
  for (char& c : out)
    if (static_cast<unsigned char>(c) < 0x20) c = '?';
  return out;
}

std::string shown(const json& value) {
  return shown(value.dump(-1, ' ', false, json::error_handler_t::replace));
}

ControlRequests::ControlRequests(run::Simulation& simulation, double rate, ControlServices services)
    : simulation_(simulation),
      rate_(rate),
      services_(services),
      feed_(map::options_for(simulation.world().description(), simulation.world().ground(),
                             map::all_layers(), simulation.session().design())) {
  // Makes the first map now, so that changes before the first request are known.
  now();
}

// A line with any key of a request is one, so that a mixed line is refused and sets nothing.
bool ControlRequests::is_request(const json& line) {
  return line.is_object() && std::any_of(std::begin(kRequests), std::end(kRequests),
                                         [&](const char* key) { return line.contains(key); });
}

/// Updates the map. It gets a new number only if a column changed.
map::UpdateFeed::Update ControlRequests::now() { return feed_.publish(simulation_.heights()); }

json ControlRequests::answer(const json& line) {
  moved_ = false;
  bytes_.clear();
  const std::string key = line.begin().key();
  if (line.size() != 1)
    refuse(key, line, "a request is a line of its own and sets no inputs", "send two lines");
  return {{key, dispatch(key, line.begin().value())}};
}

json ControlRequests::dispatch(const std::string& key, const json& what) {
  if (key == "heights") return heights(what);
  if (key == "changed") return changed(what);
  if (key == "arrays") return arrays(what);
  if (key == "frames") return frames(what);
  if (key == "particles") return particles(what);
  if (key == "image") return image(what);
  if (key == "watch") return watch(what);
  if (key == "order") return order(what);
  if (key == "progress") must_be_true(key, what);
  if (key == "progress") return progress();
  if (key == "info" || key == "reset") must_be_true(key, what);
  if (key == "info") return info();
  if (key == "reset") return replaced([&] { simulation_.reset(); });
  // Only save and load are left; both take a path.
  if (!services_.files) refuse(key, what, "this program reads and writes no states", "use reset");
  if (key == "save") return save(what);
  const std::string path = text_in(key, what);
  json out = replaced([&] { simulation_.load(path); });
  out["file"] = path;
  return out;
}

/// A snapshot may replace another snapshot and nothing else.
json ControlRequests::save(const json& what) const {
  const std::string path = text_in("save", what);
  require_snapshot_or_nothing(what, path);
  simulation_.save(path);
  return {{"file", path}, {"time", simulation_.time()}};
}

/// Answers with names and units of the outputs that are new.
json ControlRequests::watch(const json& what) {
  const std::size_t before = simulation_.outputs().size();
  simulation_.watch(text_in("watch", what));
  json out = json::object();
  for (std::size_t i = before; i < simulation_.outputs().size(); ++i)
    out[simulation_.outputs()[i].name] = simulation_.outputs()[i].unit;
  return out;
}

/// Answers {"machine": "name", "steps": "<dig>...</dig>", "now": true}.
json ControlRequests::order(const json& what) {
  if (!what.is_object() || !what.contains("machine") || !what.contains("steps"))
    refuse("order", what, "must be an object with machine and steps",
           R"({"machine": "name", "steps": "<wait><duration_s>1</duration_s></wait>"})");
  for (const auto& [key, value] : what.items())
    if (key != "machine" && key != "steps" && key != "now")
      refuse("order/" + key, value, "is none of machine, steps, now",
             suggestion(key, {"machine", "steps", "now"}));
  if (what.contains("now") && !what["now"].is_boolean())
    refuse("order/now", what["now"], "must be true or false", "true stops the running program");
  simulation_.order(text_in("order/machine", what["machine"]),
                    text_in("order/steps", what["steps"], kLongestOrder), what.value("now", false));
  return {{"time", simulation_.time()}};
}

/// Answers with the programs of all machines and the score up to now.
json ControlRequests::progress() const {
  const session::Session& session = simulation_.session();
  json programs = record::program_list(session, "running");
  for (json& one : programs)
    one["phase"] = session.phase(
        simulation_.world().description().machine_index(one["machine"].get<std::string>()));
  return {{"time", simulation_.time()},
          {"programs", programs},
          {"score",
           record::score_json(record::measure_score(session), simulation_.world().description())}};
}

/// Puts the simulation into another state by `load`. If that throws, the state and the map stay.
json ControlRequests::replaced(const std::function<void()>& load) {
  load();
  moved_ = true;
  // The map knows nothing about the time before this state.
  feed_.restart();
  now();
  return {{"time", simulation_.time()}, {"steps", simulation_.world().steps()}};
}

/// Answers {"min_m": [x, y], "max_m": [x, y], "cell_m": 0.2, "layer": "slope"}. Heights are
/// bilinear at the centres of the requested cells; other layers are those of the columns that
/// contain them.
json ControlRequests::heights(const json& what) {
  if (!what.is_object())
    refuse("heights", what, "must be an object",
           R"({"min_m": [0, 0], "max_m": [2, 1], "cell_m": 0.2})");
  const map::UpdateFeed::Update newest = now();
  const map::TerrainMap& terrain = newest->map;
  // Without corners and cell, the answer is the whole site in its own columns.
  Vec2 low = terrain.origin(), high = low + terrain.cell() * Vec2(terrain.nx(), terrain.ny());
  double cell = terrain.cell();
  map::MapLayer layer = map::MapLayer::kElevation;
  for (const auto& [key, value] : what.items()) {
    const std::string name = "heights/" + key;
    if (key == "cell_m") {
      cell = number_in(name, value, 1e-3, 1e4);
    } else if (key == "layer") {
      layer = map::layer_named(text_in(name, value));
    } else if (key == "min_m" || key == "max_m") {
      if (!value.is_array() || value.size() != 2)
        refuse(name, value, "must be [x, y]", "send two numbers in metres");
      Vec2& corner = key == "min_m" ? low : high;
      corner = Vec2(number_in(name, value[0], -1e7, 1e7), number_in(name, value[1], -1e7, 1e7));
    } else {
      refuse(name, value, "is none of min_m, max_m, cell_m, layer",
             suggestion(key, {"min_m", "max_m", "cell_m", "layer"}));
    }
  }
  // A tolerance for rounding, so that a whole number of cells does not become one more.
  const Vec2 cells = ((high - low) / cell - Vec2::Constant(1e-6)).array().ceil().matrix();
  if (!((high - low).array() > 0).all() || cells.x() * cells.y() > kMostCells)
    refuse("heights", what, "must be a rectangle of 1 to 1000000 cells",
           "max_m above min_m, or a larger cell_m");
  const int nx = std::max(1, static_cast<int>(cells.x())),
            ny = std::max(1, static_cast<int>(cells.y()));
  json values = json::array();
  for (int iy = 0; iy < ny; ++iy)
    for (int ix = 0; ix < nx; ++ix) {
      // Values belong to the middle of a cell.
      const Vec2 p = low + cell * Vec2(ix + 0.5, iy + 0.5);
      const double v = layer == map::MapLayer::kElevation
                           ? map::height(terrain, p.x(), p.y())
                           : static_cast<double>(map::value(terrain, layer, p.x(), p.y()));
      // JSON has no NaN.
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
          {"time", simulation_.time()},
          {"values", values}};
}

/// Answers with the rectangles that changed since map number `what`, and the number of the present
/// map.
json ControlRequests::changed(const json& what) {
  if (!what.is_number_unsigned())
    refuse("changed", what, "must be a whole number", "send 0, or the sequence of the last answer");
  // The map is renewed before the look-up, so that changes up to this moment are included.
  const map::UpdateFeed::Update newest = now();
  const map::UpdateFeed::Update update = feed_.since(what.get<std::uint64_t>());
  json out = {{"since", what},
              {"sequence", newest->sequence},
              {"map_time", newest->time},
              {"time", simulation_.time()},
              {"columns", 0},
              {"merged", false},
              {"rects_m", json::array()}};
  // No update: the controller has the newest map.
  if (update == nullptr) return out;
  const map::TerrainMap& terrain = update->map;
  // Rectangles of columns become rectangles in W; their upper bounds are exclusive, so they are
  // edges.
  for (const heightfield::CellRect& r : update->rects) {
    const Vec2 low = terrain.origin() + terrain.cell() * Vec2(r.x0, r.y0),
               high = terrain.origin() + terrain.cell() * Vec2(r.x1, r.y1);
    out["rects_m"].push_back({low.x(), low.y(), high.x(), high.y()});
  }
  out["since"] = update->since;
  out["columns"] = update->changed;
  out["merged"] = update->merged;
  return out;
}

/// Answers with the arrays of the given names, or with all arrays.
json ControlRequests::arrays(const json& what) const {
  const sim::ArrayOutputs& all = simulation_.arrays();
  json out = json::object();
  for (const std::string& name : names_in("arrays", what, names_of(all), kMaxArrays))
    out[name] = value_of(all.view(name));
  return out;
}

/// Answers with the arrays of the given names, whose elements follow the line in its order.
json ControlRequests::frames(const json& what) {
  const sim::ArrayOutputs& all = simulation_.arrays();
  json list = json::array();
  std::string bytes;
  for (const std::string& name : names_in("frames", what, names_of(all), kMaxArrays)) {
    const sim::ArrayView view = all.view(name);
    json one = array_header(view);
    one["name"] = name;
    one["bytes"] = view.bytes().size();
    list.push_back(std::move(one));
    bytes.append(reinterpret_cast<const char*>(view.bytes().data()), view.bytes().size());
  }
  // Only now, so that an unknown name leaves nothing behind.
  bytes_ = std::move(bytes);
  return {{"arrays", list}, {"time", simulation_.time()}, {"bytes", bytes_.size()}};
}

/// Answers with quantities of all active particles, whose elements follow the line in its order.
json ControlRequests::particles(const json& what) {
  std::vector<std::string> all;
  for (const scene::ParticleArray& one : scene::ParticleTable().arrays()) all.push_back(one.name);
  const std::vector<std::string> names = names_in("particles", what, all, all.size());
  // An unknown name is refused before the pass over the particles.
  scene::ParticleTable().arrays(names);
  const scene::ParticleTable table = sim::read_particles(simulation_.world());
  json list = json::array(), soils = json::array();
  for (const scene::ParticleArray& one : table.arrays(names)) {
    json shape = json::array({table.count()});
    for (const int length : one.shape) shape.push_back(length);
    list.push_back({{"name", one.name},
                    {"type", scene::name_of(one.type)},
                    {"shape", shape},
                    {"unit", one.unit},
                    {"meaning", one.meaning},
                    {"bytes", one.bytes.size()}});
    bytes_.append(reinterpret_cast<const char*>(one.bytes.data()), one.bytes.size());
  }
  for (const scene::ParticleSoil& soil : table.soils)
    soils.push_back({{"name", soil.name}, {"bank_density_kg_m3", soil.bank_density}});
  return {{"arrays", list},     {"soils", soils},       {"count", table.count()},
          {"time", table.time}, {"steps", table.steps}, {"bytes", bytes_.size()}};
}

/// Answers with a picture as PNG.
json ControlRequests::image(const json& what) const {
  const std::string name = text_in("image", what);
  if (!services_.images) refuse("image", what, "this program draws no pictures", "use navvy run");
  const render::Image picture = simulation_.image(name);
  const std::vector<char> png = render::encode_png(picture);
  return {{"camera", name},
          {"time", simulation_.time()},
          {"width", picture.width},
          {"height", picture.height},
          {"png_base64", base64(std::as_bytes(std::span(png)))}};
}

/// Answers with everything that a controller may need to know once.
json ControlRequests::info() const {
  const sim::World& world = simulation_.world();
  const heightfield::Terrain& ground = world.ground();
  const auto units = [](const std::vector<sim::Channel>& channels) {
    json out = json::object();
    for (const sim::Channel& channel : channels) out[channel.name] = channel.unit;
    return out;
  };
  json layers = json::object(), cameras = json::array(), arrays = json::object(),
       sensors = json::object();
  for (const sim::ArrayChannel& channel : world.arrays().channels())
    arrays[channel.name] = array_description(channel);
  for (const sensor::SensorOutput& one : sensor::sensor_outputs(world)) {
    json names = json::array();
    for (const sensor::SensorArray& array : one.arrays)
      names.push_back(one.name + "/" + array.quantity);
    sensors[one.name] = {{"type", one.description->type},
                         {"link", one.link_name},
                         {"rate_hz", one.description->rate},
                         {"latency_s", one.description->latency},
                         {"arrays", names}};
  }
  for (const map::LayerInfo& each : map::layers()) layers[each.name] = each.unit;
  for (const scene::Camera& camera : world.description().cameras) cameras.push_back(camera.name);
  return {{"scene", world.description().name},
          {"device", simulation_.session().device_name()},
          {"time", simulation_.time()},
          {"step_s", world.dt()},
          {"control_rate_hz", rate_},
          {"site",
           {{"origin_m", {ground.origin().x(), ground.origin().y()}},
            {"cell_m", ground.cell()},
            {"nx", ground.nx()},
            {"ny", ground.ny()}}},
          {"inputs", units(world.inputs().channels())},
          {"outputs", units(world.outputs().channels())},
          {"arrays", arrays},
          {"sensors", sensors},
          {"layers", layers},
          {"cameras", cameras}};
}

}  // namespace navvy::link
