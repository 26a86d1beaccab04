// SPDX-License-Identifier: Apache-2.0
#include "scene_io/assembly.h"

#include <cstring>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "core/limits.h"
#include "scene_io/mesh_path.h"
#include "scene_io/schema.h"
#include "scene_io/sdf_rules.h"
#include "scene_io/xml_limits.h"

namespace navvy::scene_io {

namespace {

bool is_called(const Element& element, const char* name) {
  return std::strcmp(element.Name(), name) == 0;
}

/// Returns true for elements that concern a machine as a whole; those of a part do not count.
bool is_of_whole(const Element& element) {
  for (const char* name : {"pose", "static", "self_collide", "allow_auto_disable", "enable_wind",
                           "navvy:physics", "navvy:traversability"})
    if (is_called(element, name)) return true;
  return false;
}

/// Returns true if the text of the element is the name of a link, joint, frame or shell.
/// <parent> and <child> belong to SDF; the schema knows the extension elements.
bool holds_name(const Element& element) {
  return is_called(element, "parent") || is_called(element, "child") ||
         is_called(element, "gearbox_reference_body") || schema().refers_to_part(element.Name());
}

/// Copies a part's elements into the whole under the part's name.
class Part {
 public:
  Part(const Element& model, std::string name, Document& whole)
      : name_(std::move(name)), whole_(whole) {
    for (const Element* e = model.FirstChildElement(); e; e = e->NextSiblingElement())
      if (const std::string own = attribute(*e, "name"); !own.empty()) names_.insert(own);
  }

  /// Returns a copy of `from`, a child of the part's model, for a place below a <model>.
  Element& copied(const Element& from) const {
    // Line and file of the original stay with the copy (Document::create), for messages of later
    // checks.
    Element& to = copy(from);
    if (const char* own = from.Attribute("name")) to.SetAttribute("name", under(own).c_str());
    // By default a joint is in the frame of its child link and a frame with attached_to in that
    // one, so only these two kinds need the frame of the part.
    const bool hangs_on_model =
        is_called(from, "link") || (is_called(from, "frame") && !from.Attribute("attached_to"));
    if (!hangs_on_model) return to;
    // By default, links and frames are in the frame of their model: the part's.
    Element* pose = to.FirstChildElement("pose");
    if (pose == nullptr) {
      pose = whole_.create("pose", from);
      pose->SetText("0 0 0 0 0 0");
      to.InsertFirstChild(pose);
    }
    if (attribute(*pose, "relative_to").empty()) pose->SetAttribute("relative_to", name_.c_str());
    return to;
  }

 private:
  std::string under(const std::string& own) const { return name_ + "::" + own; }
  /// Returns the name in the whole of what the part calls `own`.
  std::string renamed(const std::string& own) const {
    // `__model__` is SDF's name for the frame of the model; here it is the frame NAME that `put`
    // adds. Names of others, such as world, stay.
    if (own == "__model__") return name_;
    return names_.count(own) > 0 ? under(own) : own;
  }
  Element& copy(const Element& from) const {
    Element& to = *whole_.create(from.Name(), from);
    for (const auto* at = from.FirstAttribute(); at; at = at->Next()) {
      bool names_another = false;
      // These are the attributes of SDF that hold the name of a frame.
      for (const char* key : {"relative_to", "attached_to", "expressed_in"})
        names_another |= std::strcmp(at->Name(), key) == 0;
      names_another |= is_called(from, "mimic") && std::strcmp(at->Name(), "joint") == 0;
      to.SetAttribute(at->Name(), names_another ? renamed(at->Value()).c_str() : at->Value());
    }
    for (const auto* node = from.FirstChild(); node; node = node->NextSibling()) {
      if (const Element* child = node->ToElement()) {
        to.InsertEndChild(&copy(*child));
      } else if (node->ToText() && !holds_name(from)) {
        to.InsertEndChild(node->DeepClone(to.GetDocument()));
      }
    }
    if (holds_name(from)) to.SetText(renamed(text_of(from)).c_str());
    return to;
  }

  std::string name_;
  Document& whole_;
  std::set<std::string> names_;
};

/// Makes paths of meshes, which count from the part's file, absolute.
bool name_meshes(Element& element, Faults& faults) {
  bool sound = true;
  for (Element* child = element.FirstChildElement(); child; child = child->NextSiblingElement()) {
    const bool of_geometry = is_called(*child, "uri") && is_called(element, "mesh");
    const bool of_shell = is_called(*child, "mesh") && is_called(element, "navvy:shell");
    std::string path;
    // The inner element holds the path; all others are searched for such elements.
    if (!of_geometry && !of_shell) {
      sound = name_meshes(*child, faults) && sound;
    } else if (resolve_mesh(*child, path, faults)) {
      child->SetText(path.c_str());
    } else {
      sound = false;
    }
  }
  return sound;
}

/// Merges the parts of one document's models. Each file that is included has an assembler of its
/// own, whose `files_` begins with those of its includers.
class Assembler {
 public:
  Assembler(Document& document, std::vector<std::string> files, Faults& faults)
      : document_(document), files_(std::move(files)), faults_(faults) {}

  bool assemble(Element& model) {
    bool sound = true;
    for (Element* e = model.FirstChildElement(); e != nullptr;) {
      // The part takes the place of its element.
      Element* next = e->NextSiblingElement();
      if (is_called(*e, "include")) {
        sound = include(model, *e) && sound;
      } else if (is_called(*e, "model")) {
        sound = inner(model, *e) && sound;
      }
      e = next;
    }
    return sound;
  }

  bool found_any() const { return found_any_; }

 private:
  bool include(Element& model, Element& element) {
    bool sound = true;
    for (const Element* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) {
      // In a <model>, other elements of an <include> would have no meaning.
      if (is_called(*e, "uri") || is_called(*e, "name") || is_called(*e, "pose") ||
          is_called(*e, "navvy:joint"))
        continue;
      faults_.error(*e, "", "has no place in an <include> inside a <model>",
                    "an included part has uri, name, pose and navvy:joint");
      sound = false;
    }
    const Element* uri = element.FirstChildElement("uri");
    if (uri == nullptr)
      faults_.error(element, "", "needs <uri>", "the file of the model to include");
    std::string path;
    sound = sound && uri != nullptr && resolve_model(*uri, path, faults_) &&
            open(model, element, *uri, path);
    // Its faults have been reported, so no other reader must see it.
    model.DeleteChild(&element);
    return sound;
  }

  bool open(Element& model, Element& element, const Element& uri, const std::string& path) {
    std::error_code ignored;
    // Canonical names find a loop that goes through links or "..".
    const std::string file = std::filesystem::weakly_canonical(path, ignored).string();
    for (const std::string& above : files_)
      if (above == file) {
        faults_.error(uri, text_of(uri), "a model cannot be a part of itself",
                      files_.back() == file ? "name another file"
                                            : "one of the files between includes this one again");
        return false;
      }
    if (files_.size() > limits::kModelNesting) {
      faults_.error(uri, text_of(uri),
                    "models may include each other at most " +
                        std::to_string(limits::kModelNesting) + " deep",
                    "include the innermost one from further out");
      return false;
    }
    // Files and elements of a part count at each use, so that parts of parts cannot multiply
    // without bound.
    if (faults_.work.elements > limits::kSceneElements ||
        faults_.work.files > limits::kSceneFiles) {
      faults_.error(uri, text_of(uri),
                    "a scene and its machines may have at most " +
                        std::to_string(limits::kSceneElements) + " elements in " +
                        std::to_string(limits::kSceneFiles) + " files together",
                    "include fewer parts");
      return false;
    }
    const std::size_t before = faults_.error_count();
    const auto part = Document::open(path, faults_);
    if (!part || !check_root(*part->root(), faults_)) return false;
    Element* root = part->root()->FirstChildElement("model");
    if (root == nullptr) {
      faults_.error(*part->root(), "", "a machine file needs a <model>",
                    "add it, or name the file of a machine");
      return false;
    }
    // All parts become one text, which libsdformat reads by one version.
    const std::string ours = attribute(*document_.root(), "version"),
                      theirs = attribute(*part->root(), "version");
    if (ours != theirs) {
      faults_.error(uri, theirs, "a part must be of the same version of SDF, here " + ours,
                    "write version=\"" + ours + "\" in its file");
      return false;
    }
    std::vector<std::string> files = files_;
    files.push_back(file);
    // From the inside outwards: parts of the part are merged first, still with their file's name.
    Assembler parts(*part, files, faults_);
    if (parts.assemble(*root) && parts.found_any()) check_tree(*part->root(), faults_);
    // Rules are checked before copying, while each element is in its own file.
    check_sdf(*part->root(), faults_);
    // In the merged document a relative path would count from the including file.
    if (!name_meshes(*root, faults_) || faults_.error_count() > before) return false;
    const Element* name = element.FirstChildElement("name");
    // As in a world, the file's own pose does not count.
    put(model, element, *root, name ? text_of(*name) : attribute(*root, "name"),
        element.FirstChildElement("pose"));
    return true;
  }

  bool inner(Element& model, Element& element) {
    const bool sound = assemble(element);
    if (attribute(element, "name").empty()) {
      faults_.error(element, "", "needs an attribute name=\"...\"", "add it");
      model.DeleteChild(&element);
      return false;
    }
    put(model, element, element, attribute(element, "name"), element.FirstChildElement("pose"));
    model.DeleteChild(&element);
    return sound;
  }

  /// Copies the elements of `part` before `place` in `model`.
  void put(Element& model, Element& place, const Element& part, const std::string& name,
           const Element* pose) {
    const Part names(part, name, document_);
    found_any_ = true;
    // Without a sibling before it, the first element goes to the front.
    tinyxml2::XMLNode* last = place.PreviousSibling();
    const auto insert = [&](Element& element) {
      last = last ? model.InsertAfterChild(last, &element) : model.InsertFirstChild(&element);
    };
    // The frame stands for the part's model frame; its links and frames have poses relative to it.
    Element& frame = *document_.create("frame", place);
    frame.SetAttribute("name", name.c_str());
    if (pose != nullptr) {
      Element& at = *document_.create("pose", *pose);
      for (const auto* a = pose->FirstAttribute(); a; a = a->Next())
        at.SetAttribute(a->Name(), a->Value());
      at.SetText(text_of(*pose).c_str());
      frame.InsertEndChild(&at);
    }
    insert(frame);
    for (const Element* e = part.FirstChildElement(); e; e = e->NextSiblingElement())
      if (!is_of_whole(*e)) insert(names.copied(*e));
    // An inner <model> has its navvy:joint among the children copied above; those of an <include>
    // are in the including file.
    if (&place == &part) return;
    for (const Element* e = place.FirstChildElement("navvy:joint"); e;
         e = e->NextSiblingElement("navvy:joint"))
      insert(names.copied(*e));
  }

  Document& document_;
  bool found_any_ = false;
  std::vector<std::string> files_;  ///< those that include each other, down to this one
  Faults& faults_;
};

}  // namespace

bool assemble(Document& document, Faults& faults) {
  std::error_code ignored;
  Assembler assembler(
      document, {std::filesystem::weakly_canonical(document.file(), ignored).string()}, faults);
  bool sound = true;
  const auto all_of = [&](Element& parent) {
    for (Element* e = parent.FirstChildElement("model"); e; e = e->NextSiblingElement("model"))
      sound = assembler.assemble(*e) && sound;
  };
  all_of(*document.root());
  if (Element* world = document.root()->FirstChildElement("world")) all_of(*world);
  // The whole may exceed the limits of a machine.
  return sound && (!assembler.found_any() || check_tree(*document.root(), faults));
}

}  // namespace navvy::scene_io
