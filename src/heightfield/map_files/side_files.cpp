// SPDX-License-Identifier: Apache-2.0
// The files beside a map are small, and other programs write them in few forms: they are searched
// for what Navvy uses. What GDAL makes of each is tested in the build that has it.
#include "heightfield/map_files/side_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <vector>

#include "core/file.h"
#include "core/limits.h"
#include "heightfield/map_files/ascii_words.h"
#include "heightfield/map_files/beside.h"

namespace navvy::heightfield {
namespace {

namespace fs = std::filesystem;

/// The US survey foot as GDAL has it for plane coordinates, and for heights [m].
constexpr double kPlaneFoot = 0.30480060960121924, kHeightFoot = 0.304800609601219;

enum class Capitals { kIgnored, kCount };

/// Returns the path of the file beside the map with this name; empty without one.
std::string find_beside(const MapName& name, const std::string& wanted,
                        Capitals capitals = Capitals::kIgnored) {
  std::vector<std::string> names;
  try {
    names = files_beside(name.file);
  } catch (const FileError& failure) {
    name.fail("", "", failure.what(), "move that file away, or replace it");
  }
  // The first is the map itself.
  for (std::size_t i = 1; i < names.size(); ++i)
    if (names[i] == wanted ||
        (capitals == Capitals::kIgnored && lower_case(names[i]) == lower_case(wanted)))
      return (fs::path(name.file).parent_path() / names[i]).string();
  return "";
}

std::string stem_of(const MapName& name) { return fs::path(name.file).stem().string(); }

/// Returns the text of a file beside the map.
std::string text_of(const MapName& name, const std::string& path) {
  try {
    const std::vector<char> bytes = read_file(path, limits::kMapSidecarBytes);
    return {bytes.begin(), bytes.end()};
  } catch (const FileError& failure) {
    name.fail("", "", failure.what(), "move that file away, or replace it");
  }
}

std::string trimmed(const std::string& text) {
  const char* const blanks = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(blanks);
  return begin == std::string::npos ? ""
                                    : text.substr(begin, text.find_last_not_of(blanks) + 1 - begin);
}

/// Parses the six lines of a world file; false where GDAL would not take it either.
bool place_of(const std::string& text, std::array<double, 6>& place) {
  std::istringstream lines(text);
  std::array<double, 6> numbers = {};
  std::string line;
  for (double& number : numbers) {
    if (!std::getline(lines, line)) return false;
    const std::optional<double> value = map_number(trimmed(line));
    if (!value) return false;
    number = *value;
  }
  const auto& [a, d, b, e, x, y] = numbers;
  if ((a == 0 && b == 0) || (e == 0 && d == 0)) return false;
  // Its position is that of the middle of the first cell.
  place = {x - 0.5 * a - 0.5 * b, a, b, y - 0.5 * d - 0.5 * e, d, e};
  return true;
}

/// Returns the text between the first <tag ...> and </tag> of an XML text, with quotes in place of
/// their entities; empty without one.
std::string tag_text(const std::string& xml, const std::string& tag) {
  std::size_t begin = xml.find("<" + tag);
  if (begin == std::string::npos) return "";
  begin = xml.find('>', begin);
  const std::size_t end = xml.find("</" + tag + ">", begin);
  if (begin == std::string::npos || end == std::string::npos) return "";
  std::string text = trimmed(xml.substr(begin + 1, end - begin - 1));
  for (std::size_t at = 0; (at = text.find("&quot;", at)) != std::string::npos;)
    text.replace(at, 6, "\"");
  return text;
}

/// Returns the number of an element of .aux.xml; refuses one that is none.
std::optional<double> tag_number(const MapName& name, const std::string& path,
                                 const std::string& xml, const std::string& tag) {
  const std::string text = tag_text(xml, tag);
  if (text.empty()) return std::nullopt;
  const std::optional<double> value = map_number(text);
  if (!value)
    name.fail("", text, "is no number in <" + tag + "> of '" + path + "'",
              "correct that file, or move it away");
  return value;
}

/// Finds the names and the units of lengths of a CRS in the brackets of its WKT.
class WktReader {
 public:
  explicit WktReader(const std::string& text) : text_(text) {}

  /// Names and units found so far.
  RasterCrs crs;
  /// Kinds of CRS found: `known` is false if there is one that is none of these.
  bool projected = false, geographic = false, local = false, known = true;
  /// Number of units of lengths along the plane.
  int units = 0;

  /// Walks the whole text. Returns false if brackets or quotes do not match.
  bool walk() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"') {
        if (!quoted()) return false;
      } else if (c == '[' || c == '(') {
        open_.push_back(std::move(word_));
        texts_.emplace_back();
        word_.clear();
        ++at_;
      } else if (c == ']' || c == ')' || c == ',') {
        if (!word_.empty() && !texts_.empty()) texts_.back().push_back(std::move(word_));
        word_.clear();
        ++at_;
        if (c != ',' && !close()) return false;
      } else {
        if (std::isspace(static_cast<unsigned char>(c)) == 0) word_ += c;
        ++at_;
      }
    }
    return open_.empty() && word_.empty();
  }

 private:
  bool quoted() {
    const std::size_t end = text_.find('"', at_ + 1);
    if (end == std::string::npos || texts_.empty()) return false;
    texts_.back().push_back(text_.substr(at_ + 1, end - at_ - 1));
    at_ = end + 1;
    return true;
  }
  /// Takes the element that ends here.
  bool close() {
    if (open_.empty()) return false;
    const std::string element = std::move(open_.back());
    const std::vector<std::string> texts = std::move(texts_.back());
    open_.pop_back();
    texts_.pop_back();
    const std::string parent = open_.empty() ? "" : open_.back();
    const std::string first = texts.empty() ? "" : texts[0];
    const bool outer = parent.empty() || parent == "COMPD_CS";
    if (element == "PROJCS" || element == "LOCAL_CS" || (outer && element == "GEOGCS")) {
      projected = projected || element == "PROJCS";
      local = local || element == "LOCAL_CS";
      geographic = geographic || element == "GEOGCS";
      if (crs.name.empty()) crs.name = first;
    } else if (outer && (element == "VERT_CS" || element == "VERTCS")) {
      if (!crs.name.empty()) crs.name += " + " + first;
    } else if (parent.empty() && element != "COMPD_CS") {
      known = false;
    }
    if (element == "COMPD_CS") crs.name = first;
    const bool vertical = parent == "VERT_CS" || parent == "VERTCS";
    if (element != "UNIT" || (!vertical && parent != "PROJCS" && parent != "LOCAL_CS")) return true;
    const std::optional<double> metres = map_number(texts.size() > 1 ? texts[1] : "");
    if (!metres) return false;
    if (vertical) crs.vertical = true;
    (vertical ? crs.height_unit : crs.unit) = first;
    (vertical ? crs.height_metres : crs.metres) = *metres;
    units += vertical ? 0 : 1;
    return true;
  }

  const std::string& text_;
  std::size_t at_ = 0;
  std::string word_;
  /// Names of the elements that are open, and the words of each so far.
  std::vector<std::string> open_;
  std::vector<std::vector<std::string>> texts_;
};

}  // namespace

RasterCrs parse_crs(const std::string& wkt) {
  WktReader reader(wkt);
  const bool sound = reader.walk() && reader.known, plane = reader.projected || reader.local;
  RasterCrs crs = std::move(reader.crs);
  crs.degrees = reader.geographic && !plane;
  crs.declared = sound && (crs.degrees || (plane && reader.units == 1));
  // Files round the foot differently.
  if (std::abs(crs.metres - kPlaneFoot) < 1e-12) crs.metres = kPlaneFoot;
  if (std::abs(crs.height_metres - kHeightFoot) < 1e-12) crs.height_metres = kHeightFoot;
  crs.wkt = trimmed(wkt);
  return crs.declared ? crs : RasterCrs();
}

void read_world_file(const MapName& name, RasterHeader& header) {
  // The ending of a world file is the first and the last letter of the map's and a w, or the whole
  // ending and a w.
  const std::string ending = fs::path(name.file).extension().string();
  std::vector<std::string> endings = {ending + "w", ".wld"};
  if (ending.size() > 3)
    endings.insert(endings.begin(), std::string(".") + ending[1] + ending.back() + "w");
  for (const std::string& each : endings) {
    const std::string path = find_beside(name, stem_of(name) + each);
    std::array<double, 6> place = {};
    if (path.empty() || !place_of(text_of(name, path), place)) continue;
    header.place = place;
    return;
  }
}

void read_projection(const MapName& name, RasterHeader& header) {
  // GDAL looks for these two only.
  std::string path = find_beside(name, stem_of(name) + ".prj", Capitals::kCount);
  if (path.empty()) path = find_beside(name, stem_of(name) + ".PRJ", Capitals::kCount);
  if (path.empty()) return;
  const std::string text = trimmed(text_of(name, path));
  header.crs = parse_crs(text);
  if (!header.crs.declared)
    name.fail("CRS", text.substr(0, 60),
              "is no CRS in WKT 1 that this build, which has no GDAL, can read from '" + path + "'",
              "if coordinates and heights are metres, move that file away; gdalwarp -t_srs "
              "EPSG:CODE -of AAIGrid IN OUT.asc writes a map in metres");
}

void read_auxiliary(const MapName& name, RasterHeader& header) {
  const std::string path = find_beside(name, fs::path(name.file).filename().string() + ".aux.xml");
  if (path.empty()) return;
  const std::string xml = text_of(name, path);
  const std::size_t begin = xml.find("<PAMRasterBand band=\"1\"");
  const std::string band = begin == std::string::npos
                               ? ""
                               : xml.substr(begin, xml.find("</PAMRasterBand>", begin) - begin);
  header.height_unit = tag_text(band, "UnitType");
  header.scale = tag_number(name, path, band, "Scale");
  header.offset = tag_number(name, path, band, "Offset");
  if (header.kind != RasterHeader::Kind::kPicture) return;
  if (!header.nodata) header.nodata = tag_number(name, path, band, "NoDataValue");
  if (const std::string srs = tag_text(xml, "SRS"); !srs.empty()) {
    header.crs = parse_crs(srs);
    if (!header.crs.declared)
      name.fail(
          "CRS", srs.substr(0, 60),
          "is no CRS in WKT 1 that this build, which has no GDAL, can read from '" + path + "'",
          "if coordinates and heights are metres, move that file away and give map_cell_m and "
          "map_corner_m");
  }
  const std::string six = tag_text(xml, "GeoTransform");
  // A world file is preferred.
  if (six.empty() || header.place) return;
  std::array<double, 6> place = {};
  std::istringstream parts(six);
  std::string part;
  for (double& number : place) {
    const std::optional<double> value =
        std::getline(parts, part, ',') ? map_number(trimmed(part)) : std::nullopt;
    if (!value)
      name.fail("georeference", six, "are not six numbers in <GeoTransform> of '" + path + "'",
                "correct that file, or move it away");
    number = *value;
  }
  header.place = place;
}

}  // namespace navvy::heightfield
