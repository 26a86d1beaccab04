// SPDX-License-Identifier: Apache-2.0
// LandXML has its own namespace and far more elements than a scene, so it has limits of its own.
#include "scene_io/landxml.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string_view>
#include <unordered_map>

#include "core/file.h"
#include "core/limits.h"
#include "scene_io/xml_limits.h"

namespace navvy::scene_io {
namespace {

/// A file that is being read, for messages.
struct Reading {
  std::string file;
  Faults& faults;
  std::size_t before = faults.error_count();

  void error(int line, const std::string& element, const std::string& value,
             const std::string& rule, const std::string& remedy) const {
    faults.add(Fault{Fault::Severity::kError, file, line, element, value, rule, remedy});
  }
  void error(const Element& at, const std::string& value, const std::string& rule,
             const std::string& remedy) const {
    error(at.GetLineNum(), at.Name(), value.substr(0, 80), rule, remedy);
  }
  bool failed() const { return faults.error_count() > before; }
};

const Element* child(const Element* of, const char* name) {
  return of != nullptr ? of->FirstChildElement(name) : nullptr;
}

/// Returns the length of the file's unit in metres; 0 after a fault.
double read_unit(const Element& root, const Reading& reading) {
  // Names of the enumerations metLinear and impLinear of LandXML 1.2. The US survey foot is
  // 1200/3937 m; taken for the international foot, it would move a northing of 500 km by one metre.
  static const std::vector<std::pair<std::string, double>> kUnits = {
      {"millimeter", 1e-3}, {"centimeter", 1e-2},
      {"meter", 1},         {"kilometer", 1e3},
      {"foot", 0.3048},     {"inch", 0.0254},
      {"mile", 1609.344},   {"USSurveyFoot", 1200.0 / 3937.0}};
  const Element* units = child(&root, "Units");
  // The child is <Metric> or <Imperial>; both hold the attribute.
  const Element* kind = units != nullptr ? units->FirstChildElement() : nullptr;
  const char* name = kind != nullptr ? kind->Attribute("linearUnit") : nullptr;
  if (name == nullptr) {
    const Element& at = kind != nullptr ? *kind : units != nullptr ? *units : root;
    reading.error(
        at, "", "gives no unit; numbers do not distinguish feet and metres",
        "add <Units><Metric linearUnit=\"meter\"/></Units>, or <Imperial linearUnit=\"foot\"/> or "
        "\"USSurveyFoot\"");
    return 0;
  }
  for (const auto& [known, metres] : kUnits)
    if (known == name) return metres;
  std::vector<std::string> names;
  names.reserve(kUnits.size());
  for (const auto& [known, metres] : kUnits) names.push_back(known);
  reading.error(*kind, name, "is an unknown linearUnit", reading.faults.nearest(name, names));
  return 0;
}

/// Returns the Definition of the wanted surface; null after a fault.
const Element* find_definition(const Element& root, const std::string& wanted,
                               const Reading& reading) {
  std::vector<std::string> names;
  // With several surfaces and no name wanted, `found` is the last one, but the count reports that.
  const Element* found = nullptr;
  for (const Element* s = child(child(&root, "Surfaces"), "Surface"); s != nullptr;
       s = s->NextSiblingElement("Surface")) {
    names.push_back(attribute(*s, "name"));
    if (wanted.empty() || names.back() == wanted) found = s;
  }
  if (names.empty()) {
    reading.error(root, "", "holds no surface",
                  "export a TIN surface, not only alignments or points");
  } else if (found == nullptr) {
    reading.error(root, wanted, "no surface of this name in the file",
                  reading.faults.nearest(wanted, names));
  } else if (wanted.empty() && names.size() > 1) {
    reading.error(root, std::to_string(names.size()) + " surfaces", "the file holds several",
                  "name it, e.g. <surface>" + names.front() + "</surface>");
  } else if (const Element* definition = child(found, "Definition");
             definition == nullptr || attribute(*definition, "surfType") != "TIN") {
    reading.error(definition != nullptr ? *definition : *found,
                  definition != nullptr ? attribute(*definition, "surfType") : "", "is no TIN",
                  "export the surface as triangles (surfType=\"TIN\")");
  } else {
    return definition;
  }
  return nullptr;
}

/// Finds the first three words of a text. Returns the number of words, at most four.
/// Nothing is allocated here: a file has up to 1.5 million points and faces.
int split(const char* text, std::string_view words[3]) {
  int count = 0;
  for (const char* p = text; p != nullptr && *p != 0 && count <= 3;) {
    while (*p != 0 && std::strchr(" \t\r\n", *p) != nullptr) ++p;
    const char* begin = p;
    while (*p != 0 && std::strchr(" \t\r\n", *p) == nullptr) ++p;
    if (p == begin) break;
    if (count < 3) words[count] = std::string_view(begin, static_cast<std::size_t>(p - begin));
    ++count;
  }
  return count;
}

/// Points by their ids. Faulty points are included, so that faces do not report them again.
struct Ids {
  std::unordered_map<std::string, int> index;
  bool complete = true;  ///< no point is without one
};

/// Reads <P> elements, "northing easting elevation". A point that refers to another one (pntRef)
/// has no text, and a point of two numbers has no elevation; both are faults.
void read_points(const Element& definition, double metres, const Reading& reading, scene::Tin& tin,
                 Ids& ids) {
  for (const Element* p = child(child(&definition, "Pnts"), "P"); p != nullptr;
       p = p->NextSiblingElement("P")) {
    const char* text = p->GetText();
    const std::string id = attribute(*p, "id");
    const bool own_id =
        !id.empty() && ids.index.emplace(id, static_cast<int>(tin.points.size())).second;
    ids.complete = ids.complete && !id.empty();
    std::string_view words[3];
    Vec3 at = Vec3::Zero();
    bool sound = split(text, words) == 3;
    // 1e9 m is beyond every coordinate reference system, and sums of such numbers stay finite.
    for (int i = 0; i < 3 && sound; ++i)
      sound = to_number(std::string(words[i]), at[i]) && std::abs(at[i] * metres) <= 1e9;
    if (!sound) {
      reading.error(*p, text != nullptr ? text : "",
                    "a point is three numbers: northing easting elevation",
                    "points that refer to others (pntRef) are not read: export coordinates");
    } else if (!own_id) {
      reading.error(*p, id, "every point needs an id of its own", "give it another one");
    }
    // A faulty point is stored too: faces count the points by their places in this list.
    // The file has northing first, we have easting.
    tin.points.push_back(metres * Vec3(at.y(), at.x(), at.z()));
  }
}

/// Reads <F> elements, the ids of three points. Four ids would be a face of a grid surface, which
/// is no TIN.
void read_faces(const Element& definition, const Reading& reading, scene::Tin& tin,
                const Ids& ids) {
  for (const Element* f = child(child(&definition, "Faces"), "F"); f != nullptr;
       f = f->NextSiblingElement("F")) {
    // Invisible faces fill the hull around a surface that is not convex.
    if (attribute(*f, "i") == "1") continue;
    const char* text = f->GetText();
    std::string_view words[3];
    if (split(text, words) != 3) {
      reading.error(*f, text != nullptr ? text : "", "a face is the ids of three points",
                    "export it as triangles");
      continue;
    }
    std::array<int, 3> face = {};
    bool sound = true;
    for (std::size_t i = 0; i < 3; ++i) {
      // An unknown id may be that of a point without one, whose fault has been reported.
      const auto found = ids.index.find(std::string(words[i]));
      if (found != ids.index.end())
        face[i] = found->second;
      else if (ids.complete)
        reading.error(*f, std::string(words[i]), "no point of this id",
                      "add the point, or remove the face");
      sound = sound && found != ids.index.end();
    }
    if (sound) tin.faces.push_back(face);
  }
}

/// Reads the text within the limits; returns an empty one after a fault.
std::vector<char> read_text(const Reading& reading) {
  std::vector<char> text;
  try {
    text = read_file(reading.file, limits::kLandXmlBytes);
  } catch (const FileError& failure) {
    reading.error(0, "LandXML", "", failure.what(), "export one surface alone, or a coarser one");
    return {};
  }
  // Each element has at most two tags, so the count of '<' bounds the work of the parser before it
  // starts.
  const auto elements = static_cast<std::size_t>(std::count(text.begin(), text.end(), '<'));
  const std::size_t tag = overloaded_tag({text.data(), text.size()});
  if (tag != std::string_view::npos) {
    // The position is only turned into a line for the message.
    const auto line =
        std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(tag), '\n');
    reading.error(
        1 + static_cast<int>(line), "LandXML", "",
        "at most " + std::to_string(limits::kXmlAttributes) + " attributes in one element",
        "export it again");
    return {};
  }
  if (elements <= 2 * limits::kLandXmlElements) return text;
  reading.error(0, "LandXML", std::to_string(elements) + " tags",
                "more than " + std::to_string(2 * limits::kLandXmlElements),
                "export one surface alone, or a coarser one");
  return {};
}

}  // namespace

bool is_landxml(const std::string& file) {
  // The file is not parsed here, as it may be a raster of some gigabytes.
  // The root may follow a declaration and long comments.
  std::string head(65536, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(std::max<std::streamsize>(stream.gcount(), 0)));
  return head.find("<LandXML") != std::string::npos;
}

std::shared_ptr<const scene::Tin> read_landxml(const std::string& file, const std::string& surface,
                                               Faults& faults) {
  const Reading reading{file, faults};
  const std::vector<char> text = read_text(reading);
  if (text.empty()) {
    if (!reading.failed()) reading.error(0, "LandXML", "", "is empty", "export it again");
    return nullptr;
  }
  // Document::parse is for scenes: its limits are smaller, and it replaces old names of elements.
  tinyxml2::XMLDocument xml;
  if (xml.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS ||
      xml.RootElement() == nullptr) {
    reading.error(xml.ErrorLineNum(), "LandXML", xml.ErrorName(), "is no sound XML",
                  "export it again");
    return nullptr;
  }
  const Element& root = *xml.RootElement();
  if (std::strcmp(root.Name(), "LandXML") != 0) {
    reading.error(root, root.Name(), "the root must be <LandXML>", "export it as LandXML 1.2");
    return nullptr;
  }
  auto tin = std::make_shared<scene::Tin>();
  tin->file = file;
  const double metres = read_unit(root, reading);
  tin->metres = metres;
  const Element* definition = find_definition(root, surface, reading);
  if (definition == nullptr || metres == 0) return nullptr;
  tin->name = attribute(*definition->Parent()->ToElement(), "name");
  // 0 stands for no code; design_surface.cpp compares it with the code of the ground's map.
  if (const Element* crs = child(&root, "CoordinateSystem"))
    tin->epsg = crs->IntAttribute("epsgCode", 0);
  Ids ids;
  read_points(*definition, metres, reading, *tin, ids);
  read_faces(*definition, reading, *tin, ids);
  if (tin->faces.empty() && !reading.failed())
    reading.error(*definition, tin->name, "has no visible face",
                  "export the surface with its faces");
  return reading.failed() ? nullptr : tin;
}

}  // namespace navvy::scene_io
