// SPDX-License-Identifier: Apache-2.0
#include "scene_io/bucket_reader.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <utility>

#include "core/hash.h"
#include "geometry/bucket_shape.h"
#include "geometry/plate_properties.h"
#include "scene_io/element_reader.h"
#include "scene_io/sdf_rules.h"
#include "scene_io/shipped_files.h"

namespace navvy::scene_io {

namespace {

namespace fs = std::filesystem;
using scene::short_text;

constexpr double kSteel = 7850;  ///< density of the plates [kg/m3]

/// Elements that place a bucket on a machine and have no meaning in a file of its own.
constexpr const char* kOfMachine[] = {"link", "shell", "tip_m", "cut_direction", "opening"};
/// Elements from which plates are made.
constexpr const char* kOfPlates[] = {"tip_radius_m", "plate_m", "side_clearance_m", "mass_kg"};

/// Returns the directory of the file that an element was written in, which parts of a machine keep.
std::string written_in(const Element& element) {
  const Place place = place_of(element);
  return place.file != nullptr ? fs::path(*place.file).parent_path().string()
                               : Document::of(element).directory();
}

/// Reports a required element that is missing.
bool check_has(const Element& element, const char* name, const std::string& remedy,
               Faults& faults) {
  if (has(element, name)) return true;
  faults.error(element, "", std::string("needs an element <") + name + ">", remedy);
  return false;
}

geometry::BucketSize size_of(const scene::Bucket& bucket, double tip_radius) {
  geometry::BucketSize size{};
  size.width = bucket.width;
  size.tip_radius = tip_radius;
  size.plate = bucket.plate;
  size.clearance = bucket.clearance < 0 ? bucket.width / 30 : bucket.clearance;
  return size;
}

/// Returns the factor on the depth of the bucket's profile; nothing after an error.
std::optional<double> depth_of(const Element& element, const scene::Bucket& bucket,
                               const geometry::BucketSize& size, Faults& faults) {
  const std::size_t before = faults.error_count();
  if (size.plate > 0.1 * std::min(size.width, size.tip_radius))
    faults.error(child_or_self(element, "plate_m"), short_text(size.plate),
                 "plates are at most a tenth as thick as the bucket's width and tip radius, " +
                     short_text(0.1 * std::min(size.width, size.tip_radius), 4) + " m",
                 "give thinner plates");
  if (size.clearance > 0.2 * size.width)
    faults.error(child_or_self(element, "side_clearance_m"), short_text(size.clearance),
                 "is at most a fifth of the width, " + short_text(0.2 * size.width, 4) + " m",
                 "give less");
  if (faults.error_count() > before) return std::nullopt;
  const auto [least, most] = geometry::heaped_capacities(size);
  if (bucket.capacity < least || bucket.capacity > most) {
    faults.error(child_or_self(element, "capacity_m3"), short_text(bucket.capacity),
                 "a bucket " + short_text(size.width, 4) + " m wide with its edge " +
                     short_text(size.tip_radius, 4) + " m from the pin holds " +
                     short_text(least, 3) + " to " + short_text(most, 3) + " m3 heaped",
                 "give another capacity_m3, width_m or tip_radius_m");
    return std::nullopt;
  }
  return geometry::depth_for(size, bucket.capacity);
}

/// A bucket that is to be made, on its link.
struct Fitting {
  const Element& element;
  scene::Bucket bucket;
  const scene::Bucket* replaced;  ///< null: none
  scene::Machine& machine;
  Faults& faults;
  scene::Link* link = nullptr;
  Vec3 p_pin = Vec3::Zero();  ///< pin in the link's frame [m]
  Mat3 R_LB = Mat3::Identity();
  geometry::BucketSize size{};
  double depth = 1;

  /// Returns the bucket as fitted; nothing after an error.
  std::optional<scene::Bucket> fit() {
    if (!place()) return std::nullopt;
    const std::optional<double> factor = depth_of(element, bucket, size, faults);
    if (!factor) return std::nullopt;
    depth = *factor;
    const double was = link->mass;
    make_shell();
    make_picture();
    bucket.p_tip = p_pin + R_LB * Vec3(size.tip_radius, 0, 0);
    bucket.cut_direction = R_LB * geometry::cut_direction(size, depth);
    bucket.opening = -R_LB.col(2);
    std::array<char, 128> text{};
    std::snprintf(text.data(), text.size(), "%.3g m3 heaped, cuts %.3g m, %.4g kg", bucket.capacity,
                  bucket.width, link->mass);
    machine.derived.push_back(
        "bucket '" + (bucket.name.empty() ? bucket.shell : bucket.name) + "' is made of plates: " +
        text.data() + (replaced ? ", in place of one of " + short_text(was, 4) + " kg" : ""));
    return bucket;
  }

 private:
  /// Finds link, pin and axes.
  bool place() {
    if (bucket.link.empty() && replaced) bucket.link = replaced->link;
    const int index = machine.link_index(bucket.link);
    if (index < 0) {
      faults.error(child_or_self(element, "link"), bucket.link,
                   "needs <link>, as the machine has " +
                       std::string(machine.buckets.empty() ? "no bucket" : "several buckets") +
                       " to replace",
                   "name the link of the bucket");
      return false;
    }
    link = &machine.links[static_cast<std::size_t>(index)];
    for (const scene::Joint& joint : machine.joints)
      if (joint.child == index) p_pin = joint.X_LcJ.translation();
    if (!has(element, "tip_m")) {
      if (!replaced)
        return check_has(element, "tip_m", "the middle of the cutting edge in the link's frame",
                         faults);
      bucket.p_tip = replaced->p_tip;
      if (!has(element, "opening")) bucket.opening = replaced->opening;
    }
    const Vec3 radius = bucket.p_tip - p_pin;
    if (radius.norm() < 0.05) {
      faults.error(child_or_self(element, "tip_m"), child_text(element, "tip_m"),
                   "the cutting edge must be at least 0.05 m from the bucket's pin", "move it");
      return false;
    }
    R_LB.col(0) = radius.normalized();
    const Vec3 inward = -(bucket.opening - bucket.opening.dot(R_LB.col(0)) * R_LB.col(0));
    if (inward.norm() < 0.1) {
      faults.error(child_or_self(element, "opening"), child_text(element, "opening"),
                   "the mouth must not open along the line from the pin to the cutting edge",
                   "give a direction across it");
      return false;
    }
    R_LB.col(2) = inward.normalized();
    R_LB.col(1) = R_LB.col(2).cross(R_LB.col(0));
    size = size_of(bucket, bucket.tip_radius > 0 ? bucket.tip_radius : radius.norm());
    return true;
  }

  geometry::TriangleMesh in_link(geometry::TriangleMesh mesh) const {
    for (Vec3& v : mesh.vertices) v = p_pin + R_LB * v;
    return mesh;
  }

  /// Makes the shell, and mass and inertia of its plates.
  void make_shell() {
    scene::Shell shell;
    // The cutting edge is as thick as the plates, and what the soil feels of the steel stays.
    shell.edge_share = 1;
    if (replaced)
      for (const scene::Shell& old : machine.shells)
        if (old.name == replaced->shell) shell = old;
    shell.name = replaced ? replaced->shell : bucket.name.empty() ? bucket.link : bucket.name;
    shell.link = bucket.link;
    shell.mesh.clear();
    shell.half_thickness = 0.5 * size.plate;
    static_cast<geometry::TriangleMesh&>(shell) = in_link(geometry::bucket_shell(size, depth));
    const geometry::SolidProperties plates = geometry::plate_properties(shell, size.plate);
    link->mass = bucket.mass > 0 ? bucket.mass : kSteel * plates.volume;
    link->p_LCom = plates.p_BCom;
    link->inertia = link->mass / plates.volume * plates.inertia;
    link->density = 0;
    // The shell touches bodies and rock.
    link->collisions.clear();
    std::erase_if(machine.shells, [&](const scene::Shell& old) { return old.name == shell.name; });
    bucket.shell = shell.name;
    machine.shells.push_back(std::move(shell));
  }

  void make_picture() {
    const scene::Teeth teeth = bucket.teeth.value_or(scene::Teeth{0, 0, 0, kPi});
    std::vector<Vec2> pins;
    const auto add = [&](const Vec3& p_L) {
      const Vec3 p = R_LB.transpose() * (p_L - p_pin);
      // A pin that is far away is none of the ears'.
      if (p.norm() < size.tip_radius) pins.emplace_back(p.x(), p.z());
    };
    for (const scene::Cylinder& cylinder : machine.cylinders) {
      if (cylinder.rod_link == bucket.link)
        add(cylinder.has_linkage ? cylinder.p_coupler : cylinder.p_rod);
      if (cylinder.base_link == bucket.link) add(cylinder.p_base);
    }
    auto mesh = std::make_shared<geometry::TriangleMesh>(in_link(
        geometry::bucket_picture(size, depth, {teeth.number, teeth.width, teeth.length}, pins)));
    scene::Visual visual;
    visual.name = bucket.shell;
    visual.color = link->visuals.empty() ? scene::Color{0.35f, 0.35f, 0.37f, 1.0f}
                                         : link->visuals.front().color;
    visual.geometry.kind = scene::Geometry::Kind::kMesh;
    StateHash hash;
    for (const Vec3& v : mesh->vertices) hash.bytes(v.data(), sizeof v);
    visual.geometry.mesh_file = "bucket:" + hash.hex();
    visual.geometry.made = std::move(mesh);
    link->visuals = {visual};
  }
};

/// Returns the remedy for a bucket without the numbers of plates.
std::string way_to_numbers() {
  std::string names;
  for (const std::string& one : shipped_files("buckets"))
    names += (names.empty() ? "" : ", ") + one;
  return "or a <shell>, or ref to a bucket file: " + names;
}

/// Checks what must stand in the element, with or without a shell.
bool check_form(const Element& element, Faults& faults) {
  const std::size_t before = faults.error_count();
  if (has(element, "shell")) {
    check_has(element, "link", "add it", faults);
    check_has(element, "tip_m", "add it", faults);
    for (const char* name : kOfPlates)
      if (const Element* e = element.FirstChildElement(name))
        faults.error(*e, text_of(*e), "belongs to a bucket that is made of plates",
                     "remove it, or remove <shell>");
  } else {
    for (const char* name : {"capacity_m3", "width_m"})
      if (!has(element, name)) check_has(element, name, way_to_numbers(), faults);
    if (const Element* e = element.FirstChildElement("cut_direction"))
      faults.error(*e, text_of(*e), "follows from the shape of a bucket without <shell>",
                   "remove it");
  }
  return faults.error_count() == before;
}

using Slots = std::vector<std::optional<scene::Bucket>>;

/// Returns the index of the bucket in `slots` that one on `link` replaces; without a name of a link
/// the only one. -1: none.
int replaced_by(const std::string& link, const Slots& slots) {
  int found = -1, count = 0;
  for (std::size_t i = 0; i < slots.size(); ++i)
    if (slots[i] && (link.empty() || slots[i]->link == link)) {
      found = static_cast<int>(i);
      ++count;
    }
  return count == 1 ? found : -1;
}

}  // namespace

void fill_in_bucket(Element& bucket, Faults& faults) {
  const std::string ref = attribute(bucket, "ref");
  if (ref.empty()) return;
  const std::string file = data_file(written_in(bucket), ref, "buckets");
  std::error_code ignored;
  if (file.empty() || !fs::is_regular_file(file, ignored)) {
    faults.error(bucket, ref, "no such bucket file", faults.nearest(ref, shipped_files("buckets")));
    return;
  }
  const auto document = Document::open(file, faults);
  if (!document) return;
  const std::size_t before = faults.error_count();
  // Faults of the file have its own name and lines.
  check_bucket_file(*document, faults);
  if (faults.error_count() > before) return;
  const Element& from = *document->root()->FirstChildElement("navvy:bucket");
  add_missing(bucket, from);
  if (attribute(bucket, "name").empty() && !attribute(from, "name").empty())
    bucket.SetAttribute("name", attribute(from, "name").c_str());
}

void make_buckets(Element& model, scene::Machine& machine, Faults& faults) {
  const std::vector<Element*> elements = children_of(model, {"navvy:bucket"});
  Slots slots(machine.buckets.size());
  for (std::size_t i = 0; i < slots.size(); ++i)
    if (!faults.has_fault(*elements.at(i)) && check_form(*elements[i], faults) &&
        has(*elements[i], "shell"))
      slots[i] = machine.buckets[i];
  for (std::size_t i = 0; i < slots.size() && !machine.links.empty(); ++i) {
    if (has(*elements[i], "shell") || faults.has_fault(*elements[i])) continue;
    const int at = replaced_by(machine.buckets[i].link, slots);
    const std::size_t slot = at >= 0 ? static_cast<std::size_t>(at) : i;
    const std::optional<scene::Bucket> old = slots[slot];
    slots[slot] =
        Fitting{*elements[i], machine.buckets[i], old ? &*old : nullptr, machine, faults}.fit();
  }
  machine.buckets.clear();
  for (const auto& slot : slots)
    if (slot) machine.buckets.push_back(*slot);
}

void fit_bucket(const Element& element, const scene::Bucket& asked, scene::Machine& machine,
                Faults& faults) {
  if (machine.links.empty() || faults.has_fault(element)) return;
  if (const Element* shell = element.FirstChildElement("shell")) {
    faults.error(*shell, text_of(*shell), "the bucket of an <include> is made of plates",
                 "remove <shell>");
    return;
  }
  if (!check_form(element, faults)) return;
  check_teeth(element, asked, faults);
  if (faults.has_fault(element)) return;
  Slots slots(machine.buckets.begin(), machine.buckets.end());
  const int at = replaced_by(asked.link, slots);
  const std::optional<scene::Bucket> old =
      at >= 0 ? slots[static_cast<std::size_t>(at)] : std::nullopt;
  const auto made = Fitting{element, asked, old ? &*old : nullptr, machine, faults}.fit();
  if (!made) return;
  if (at >= 0)
    machine.buckets[static_cast<std::size_t>(at)] = *made;
  else
    machine.buckets.push_back(*made);
}

// Teeth stand side by side on the cutting edge.
void check_teeth(const Element& element, const scene::Bucket& bucket, Faults& faults) {
  const Element* teeth = element.FirstChildElement("teeth");
  if (teeth == nullptr || !bucket.teeth) return;
  const double width = bucket.teeth->number * bucket.teeth->width;
  // The factor allows for rounding where the teeth fill the width exactly.
  if (width > bucket.width * (1 + 1e-9))
    faults.error(
        child_or_self(*teeth, "width_m"),
        std::to_string(bucket.teeth->number) + " teeth of " + short_text(bucket.teeth->width) +
            " m",
        "together, the teeth are at most as wide as the bucket, " + short_text(bucket.width) + " m",
        "give fewer or narrower teeth, or correct width_m of the bucket");
}

bool bucket_weighs(const Element& model, const std::string& link) {
  for (const Element* e = model.FirstChildElement("navvy:bucket"); e;
       e = e->NextSiblingElement("navvy:bucket"))
    if (!has(*e, "shell") && child_text(*e, "link") == link) return true;
  return false;
}

void check_bucket_file(Document& document, Faults& faults) {
  if (!check_root(*document.root(), faults)) return;
  Element* element = document.root()->FirstChildElement("navvy:bucket");
  if (element == nullptr) {
    faults.error(*document.root(), "", "a bucket file needs a <navvy:bucket>", "add it");
    return;
  }
  if (!attribute(*element, "ref").empty())
    faults.error(*element, attribute(*element, "ref"), "ref is for machines and scenes",
                 "give the values here");
  for (const char* name : kOfMachine)
    if (const Element* e = element->FirstChildElement(name))
      faults.error(*e, text_of(*e), "belongs to the machine that carries the bucket",
                   "remove it; <navvy:bucket ref=\"...\"> in the machine may give it");
  scene::Bucket bucket;
  read_element(*element, bucket, nullptr, faults);
  for (const char* name : {"capacity_m3", "width_m"}) check_has(*element, name, "add it", faults);
  if (faults.has_fault(*element)) return;
  check_teeth(*element, bucket, faults);
  // Without a radius of its own the bucket has that of the machine, which decides what it holds.
  if (bucket.tip_radius > 0) depth_of(*element, bucket, size_of(bucket, bucket.tip_radius), faults);
}

}  // namespace navvy::scene_io
