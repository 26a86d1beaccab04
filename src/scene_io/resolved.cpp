// SPDX-License-Identifier: Apache-2.0
#include "scene_io/resolved.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <vector>

#include "core/hash.h"
#include "scene_io/assembly.h"
#include "scene_io/bucket_reader.h"
#include "scene_io/element_reader.h"
#include "scene_io/loader.h"
#include "scene_io/materials_reader.h"
#include "scene_io/mesh_path.h"
#include "scene_io/sensor_reader.h"
#include "scene_io/soil_reader.h"

namespace navvy::scene_io {

namespace fs = std::filesystem;

namespace {

constexpr const char* kScheme = "model://";
// Maps may hold gigabytes, of which a run reads a part [bytes].
constexpr std::size_t kHashedMost = std::size_t{64} << 20;

std::string absolute(const std::string& path) {
  std::error_code failed;
  const fs::path full = fs::weakly_canonical(fs::absolute(path, failed), failed);
  return failed ? path : full.string();
}

/// Returns model://NAME/... for a file below a vehicles/ directory, so that the text can be used on
/// other machines; else `path`.
std::string portable(const std::string& path) {
  for (const std::string& directory : data_directories()) {
    const std::string vehicles = absolute(directory + "/vehicles") + "/";
    if (path.compare(0, vehicles.size(), vehicles) == 0)
      return kScheme + path.substr(vehicles.size());
  }
  return path;
}

/// Returns the file of a portable name; empty if there is none.
std::string file_behind(const std::string& name) {
  if (name.rfind(kScheme, 0) == 0)
    return find_data("vehicles/" + name.substr(std::strlen(kScheme)));
  std::error_code ignored;
  return fs::exists(name, ignored) ? name : "";
}

/// Returns a hash of a file's size and first kHashedMost bytes.
std::string hash_of(const std::string& path) {
  std::error_code failed;
  StateHash hash;
  // The list may be written by hand: a pipe or device has no end.
  if (!fs::is_regular_file(path, failed)) return "";
  hash.value(static_cast<std::uint64_t>(fs::file_size(path, failed)));
  std::ifstream stream(path, std::ios::binary);
  std::vector<char> chunk(1 << 20);
  for (std::size_t read = 0; read < kHashedMost && stream; read += chunk.size()) {
    stream.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    hash.bytes(chunk.data(), static_cast<std::size_t>(stream.gcount()));
  }
  return hash.hex();
}

/// Visits every element below `parent` in the order of the file.
template <class Visit>
void visit_all(Element& parent, const Visit& visit) {
  for (Element* child = parent.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    visit(*child);
    visit_all(*child, visit);
  }
}

bool is_called(const tinyxml2::XMLNode* node, const char* name) {
  return node != nullptr && node->ToElement() != nullptr && std::strcmp(node->Value(), name) == 0;
}

/// Writes out one scene, and collects the files that stay outside. Steps must run while elements
/// still belong to the documents that their paths count from.
class Resolver {
 public:
  explicit Resolver(Element& world) : world_(world) {}

  void soil(Element& element, const scene::Soil& read);
  void ground(const scene::Scene& world);
  void materials();
  void include(Element& element);
  /// Replaces the paths of meshes; `model` still belongs to the file that they count from.
  void meshes(Element& model);
  /// Writes out the presets of the sensors in `parent`.
  void sensors(Element& parent);
  /// Writes out the bucket files of the buckets in `parent`.
  void buckets(Element& parent);
  void list_files();

 private:
  void keep(Element& element, const std::string& path) {
    const std::string name = portable(path);
    files_[name] = hash_of(path);
    element.SetText(name.c_str());
  }

  Element& world_;
  Faults none_;                               ///< the readers have reported all faults
  std::map<std::string, std::string> files_;  ///< hash by name
};

void Resolver::soil(Element& element, const scene::Soil& read) {
  const std::string ref = attribute(element, "ref");
  // A soil without a reference is complete.
  if (ref.empty()) return;
  const auto document = Document::open(soil_file(element, ref), none_);
  Element* base = document ? document->root()->FirstChildElement("navvy:soil") : nullptr;
  if (base == nullptr) return;
  // Either element gives the strength, so the scene's own replaces both.
  const bool own_strength = element.FirstChildElement("friction_angle_deg") ||
                            element.FirstChildElement("repose_angle_deg");
  for (Element* value = base->FirstChildElement(); value != nullptr;
       value = value->NextSiblingElement()) {
    const bool strength =
        is_called(value, "friction_angle_deg") || is_called(value, "repose_angle_deg");
    if (element.FirstChildElement(value->Name()) != nullptr || (strength && own_strength)) continue;
    element.InsertEndChild(value->DeepClone(element.GetDocument()));
  }
  // The default of the residual cohesion depends on both files.
  if (Element* old = element.FirstChildElement("residual_cohesion_pa")) element.DeleteChild(old);
  element.InsertNewChildElement("residual_cohesion_pa")
      ->SetText(scene::exact_text(read.residual_cohesion).c_str());
  element.DeleteAttribute("ref");
  element.SetAttribute("name", read.name.c_str());
}

void Resolver::ground(const scene::Scene& world) {
  Element* ground = world_.FirstChildElement("navvy:ground");
  Element* file = ground != nullptr ? ground->FirstChildElement("file") : nullptr;
  // The reader has found out from where the name counts.
  if (file != nullptr && !world.ground.file.empty()) keep(*file, absolute(world.ground.file));
  Element* design = world_.FirstChildElement("navvy:design");
  file = design != nullptr ? design->FirstChildElement("file") : nullptr;
  if (file != nullptr && !world.design.file.empty()) keep(*file, absolute(world.design.file));
}

void Resolver::materials() {
  Element* table = world_.FirstChildElement("navvy:materials");
  Element* file = table != nullptr ? table->FirstChildElement("file") : nullptr;
  if (file == nullptr) return;
  const auto document = Document::open(materials_file(*file), none_);
  const Element* shared =
      document ? document->root()->FirstChildElement("navvy:materials") : nullptr;
  if (shared == nullptr) return;
  // Pairs of the file come before those of the scene, wherever <file> stands.
  table->DeleteChild(file);
  tinyxml2::XMLNode* last = nullptr;
  for (const Element* pair = shared->FirstChildElement("pair"); pair;
       pair = pair->NextSiblingElement("pair")) {
    tinyxml2::XMLNode* copy = pair->DeepClone(table->GetDocument());
    last = last == nullptr ? table->InsertFirstChild(copy) : table->InsertAfterChild(last, copy);
  }
}

void Resolver::meshes(Element& model) {
  visit_all(model, [&](Element& element) {
    const bool of_geometry = is_called(&element, "uri") && is_called(element.Parent(), "mesh");
    const bool of_shell = is_called(&element, "mesh") && is_called(element.Parent(), "navvy:shell");
    std::string path;
    if ((of_geometry || of_shell) && resolve_mesh(element, path, none_)) keep(element, path);
  });
}

void Resolver::sensors(Element& parent) {
  visit_all(parent, [&](Element& element) {
    if (!is_called(&element, "sensor") && !is_called(&element, "navvy:sensor")) return;
    fill_in_preset(element, none_);
    while (Element* preset = element.FirstChildElement("navvy:preset")) element.DeleteChild(preset);
  });
}

void Resolver::buckets(Element& parent) {
  visit_all(parent, [&](Element& element) {
    if (!is_called(&element, "navvy:bucket")) return;
    fill_in_bucket(element, none_);
    element.DeleteAttribute("ref");
  });
}

void Resolver::include(Element& element) {
  Element* uri = element.FirstChildElement("uri");
  std::string path;
  // A missing file was reported when the scene was read.
  if (uri == nullptr || !resolve_model(*uri, path, none_)) return;
  const auto document = Document::open(path, none_);
  Element* model = document ? document->root()->FirstChildElement("model") : nullptr;
  if (model == nullptr || !assemble(*document, none_)) return;
  // SDF of another version stays outside, with its hash.
  const Element& root = *element.GetDocument()->RootElement();
  if (attribute(*document->root(), "version") != attribute(root, "version"))
    return keep(*uri, absolute(path));
  meshes(*model);
  sensors(*model);
  buckets(*model);
  // The copy belongs to this document; the machine's own document ends with this function.
  Element& inlined = *model->DeepClone(element.GetDocument())->ToElement();
  if (element.FirstChildElement("name"))
    inlined.SetAttribute("name", child_text(element, "name").c_str());
  // The pose of a machine's file does not count.
  while (Element* pose = inlined.FirstChildElement("pose")) inlined.DeleteChild(pose);
  for (const Element* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    if (is_called(child, "uri") || is_called(child, "name")) continue;
    if (is_called(child, "static")) {
      // false here does not release a machine that its file makes static.
      if (text_of(*child) != "true" && text_of(*child) != "1") continue;
      while (Element* own = inlined.FirstChildElement("static")) inlined.DeleteChild(own);
    }
    // The element of the scene replaces that of the file.
    if (is_called(child, "navvy:physics"))
      while (Element* own = inlined.FirstChildElement("navvy:physics")) inlined.DeleteChild(own);
    inlined.InsertEndChild(child->DeepClone(element.GetDocument()));
  }
  // Machines are numbered in the order of the file.
  world_.InsertAfterChild(&element, &inlined);
  world_.DeleteChild(&element);
}

void Resolver::list_files() {
  // Every file has been named by now.
  Element& list = *world_.InsertNewChildElement("navvy:resolved");
  list.SetAttribute("format", kResolvedFormat);
  for (const auto& [name, hash] : files_) {
    Element& file = *list.InsertNewChildElement("file");
    file.SetAttribute("hash", hash.c_str());
    file.SetText(name.c_str());
  }
}

}  // namespace

std::string resolved_text(Document& document, const scene::Scene& world) {
  Element& root = *document.root()->FirstChildElement("world");
  // A resolved scene gets a new list.
  while (Element* old = root.FirstChildElement("navvy:resolved")) root.DeleteChild(old);
  Resolver resolver(root);
  std::size_t soil = 0;
  for (Element* e = root.FirstChildElement("navvy:soil"); e != nullptr;
       e = e->NextSiblingElement("navvy:soil"))
    resolver.soil(*e, world.soils.at(soil++));
  resolver.ground(world);
  resolver.materials();
  for (Element* e = root.FirstChildElement("model"); e != nullptr;
       e = e->NextSiblingElement("model"))
    resolver.meshes(*e);
  resolver.sensors(root);
  resolver.buckets(root);
  for (Element* e = root.FirstChildElement("include"); e != nullptr;) {
    // The include is replaced by a model.
    Element* next = e->NextSiblingElement("include");
    resolver.include(*e);
    e = next;
  }
  resolver.list_files();
  return document.text();
}

void check_resolved(Document& document, Faults& faults) {
  Element* world = document.root()->FirstChildElement("world");
  Element* list = world != nullptr ? world->FirstChildElement("navvy:resolved") : nullptr;
  if (list == nullptr) return;
  const std::string format = attribute(*list, "format");
  if (format != std::to_string(kResolvedFormat)) {
    faults.error(*list, format, "this version reads format " + std::to_string(kResolvedFormat),
                 "use the version of Navvy that wrote it");
    return;
  }
  for (Element* e = list->FirstChildElement(); e; e = e->NextSiblingElement()) {
    const Element& file = *e;
    if (std::strcmp(file.Name(), "file") != 0) {
      faults.error(file, text_of(file), "unknown element", "only <file> has a place here");
      continue;
    }
    // A missing file is reported where it is used.
    const std::string path = file_behind(text_of(file));
    if (!path.empty() && hash_of(path) != attribute(file, "hash"))
      faults.warning(file, text_of(file), "this file has changed since the run",
                     "results may differ from the run's");
  }
}

}  // namespace navvy::scene_io
