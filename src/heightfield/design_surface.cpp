// SPDX-License-Identifier: Apache-2.0
// All three kinds of design are converted to heights at column centres.
#include "heightfield/design_surface.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "core/error.h"
#include "core/log.h"
#include "heightfield/map_files/import_design.h"
#include "heightfield/span_text.h"

namespace navvy::heightfield {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

bool known(float value) { return value == value; }

[[noreturn]] void fail(const std::string& file, int line, const std::string& value,
                       const std::string& rule, const std::string& remedy) {
  throw InputError(Fault{Fault::Severity::kError, file, line, "navvy:design", value, rule, remedy});
}

// Returns the centre of a column in W [m].
Vec2 centre(const Terrain& site, int ix, int iy) {
  return site.origin() + site.cell() * Vec2(ix + 0.5, iy + 0.5);
}

/// Returns the columns whose centres may lie in a box in W.
CellRect columns_in(const Terrain& site, const Vec2& low, const Vec2& high) {
  // Clamped as doubles, because a surface may reach far beyond any site.
  const Vec2 most(site.nx(), site.ny());
  const Vec2 a =
      ((low - site.origin()) / site.cell()).array().floor().max(0).min(most.array()).matrix();
  const Vec2 b =
      ((high - site.origin()) / site.cell()).array().ceil().max(0).min(most.array()).matrix();
  return {static_cast<int>(a.x()), static_cast<int>(a.y()), static_cast<int>(b.x()),
          static_cast<int>(b.y())};
}

// Returns a surface without heights.
DesignSurface nowhere(const CellRect& rect) {
  return {rect, std::vector<float>(static_cast<std::size_t>(rect.area()), kNone)};
}

// Returns the height of a column for writing.
float& value(DesignSurface& design, int ix, int iy) {
  const CellRect& r = design.rect;
  return design.z[static_cast<std::size_t>(iy - r.y0) * static_cast<std::size_t>(r.x1 - r.x0) +
                  static_cast<std::size_t>(ix - r.x0)];
}

// --- Triangles.

/// Place of W in survey coordinates, in metres.
Vec3 to_survey(const GroundSetup& setup) {
  // easting and northing are the coordinates of `origin`, the site's corner, in the map's unit.
  return {setup.easting * setup.file_unit - setup.origin.x(),
          setup.northing * setup.file_unit - setup.origin.y(), setup.height_offset};
}

/// Returns the EPSG code of the element whose bracket is at `open`, ignoring nested elements; 0 if
/// there is none.
int code_of(const std::string& wkt, std::size_t open) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = open; i < wkt.size(); ++i) {
    const char c = wkt[i];
    // Quotes in names are doubled.
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    // The character before must not belong to a longer word, such as BASEID.
    if (depth == 1 && std::isalnum(static_cast<unsigned char>(wkt[i - 1])) == 0 &&
        wkt.compare(i, 10, "ID[\"EPSG\",") == 0)
      return std::atoi(wkt.c_str() + i + 10);
    depth += c == '[' ? 1 : c == ']' ? -1 : 0;
    if (c == ']' && depth == 0) break;
  }
  return 0;
}

/// Returns the EPSG codes of the plane coordinates of a WKT2: that of its projected CRS, which may
/// be part of a compound one, and then that of the compound.
std::vector<int> codes_of(const std::string& wkt) {
  std::vector<int> out;
  const std::size_t projected = wkt.find("PROJCRS[");
  if (projected == std::string::npos) return out;
  for (const std::size_t element : {projected, wkt.find("COMPOUNDCRS[")})
    if (element != std::string::npos)
      if (const int code = code_of(wkt, wkt.find('[', element)); code != 0) out.push_back(code);
  return out;
}

std::string epsg_text(int code) { return "EPSG:" + std::to_string(code); }

void warn(const scene::Tin& tin, const std::string& value, const std::string& rule,
          const std::string& remedy) {
  log_warning(
      Fault{Fault::Severity::kWarning, tin.file, 0, "navvy:design", value, rule, remedy}.text());
}

// Refuses a TIN in another CRS. Where one side has no code it can only warn.
void require_same_crs(const scene::Tin& tin, const GroundSetup& setup) {
  const std::vector<int> site = codes_of(setup.crs_wkt);
  if (tin.epsg != 0 && site.empty())
    warn(tin, epsg_text(tin.epsg),
         setup.crs_wkt.empty()
             ? "the site has no CRS, so it is unknown whether both use the same coordinates"
             : "the CRS of the site's map has no EPSG code to compare with",
         "give the ground's map its code: gdal_translate -a_srs EPSG:CODE IN OUT.tif; a procedural "
         "site counts in W");
  if (site.empty()) return;
  if (tin.epsg == 0)
    warn(tin, "", "the file names no EPSG code, the site's map is in " + epsg_text(site[0]),
         "see that both are the same and add <CoordinateSystem epsgCode=\"" +
             std::to_string(site[0]) + "\"/>");
  else if (std::find(site.begin(), site.end(), tin.epsg) == site.end())
    fail(tin.file, 0, epsg_text(tin.epsg), "the site's map is in " + epsg_text(site[0]),
         "export both in one coordinate system");
}

/// The two feet differ by two parts in a million: nothing on the site, but metres at coordinates of
/// millions.
void warn_of_feet(const scene::Tin& tin, const GroundSetup& setup) {
  const double off = std::abs(tin.metres / setup.file_unit - 1);
  // The bounds enclose the two parts in a million between the two feet, and no other two units.
  if (!(off > 1e-7) || off > 1e-5) return;
  char units[80], apart[32];
  std::snprintf(units, sizeof units, "counts in %.10g m, the site's map in %.10g m", tin.metres,
                setup.file_unit);
  std::snprintf(apart, sizeof apart, "%.2g",
                off * Vec2(setup.easting, setup.northing).norm() * setup.file_unit);
  warn(
      tin, "",
      std::string(units) + ": US survey feet and international feet are " + apart + " m apart here",
      "if the coordinates are the same numbers, correct linearUnit (USSurveyFoot or foot)");
}

// Converts the corners to W once, and then walks the columns under each triangle.
DesignSurface of_tin(const scene::Tin& tin, const Terrain& site) {
  const GroundSetup& setup = site.setup();
  require_same_crs(tin, setup);
  warn_of_feet(tin, setup);
  // Triangles are stored in W, whose numbers are small.
  const Vec3 shift = to_survey(setup);
  Vec3 low = Vec3::Constant(INFINITY), high = -low;
  for (const auto& face : tin.faces)
    for (const int i : face) {
      low = low.cwiseMin(tin.points[static_cast<std::size_t>(i)]);
      high = high.cwiseMax(tin.points[static_cast<std::size_t>(i)]);
    }
  DesignSurface out = nowhere(columns_in(site, (low - shift).head<2>(), (high - shift).head<2>()));
  bool any = false;
  for (const auto& face : tin.faces) {
    const auto corner = [&](std::size_t i) -> Vec3 {
      return tin.points[static_cast<std::size_t>(face[i])] - shift;
    };
    const Vec3 a = corner(0), b = corner(1) - a, c = corner(2) - a;
    const double twice = b.x() * c.y() - b.y() * c.x();
    // A vertical or degenerate sliver covers no column.
    if (!(std::abs(twice) > 0)) continue;
    const Vec2 from = Vec2::Zero().cwiseMin(b.head<2>()).cwiseMin(c.head<2>()) + a.head<2>();
    const Vec2 to = Vec2::Zero().cwiseMax(b.head<2>()).cwiseMax(c.head<2>()) + a.head<2>();
    const CellRect rect = columns_in(site, from, to).cut(out.rect);
    for (int iy = rect.y0; iy < rect.y1; ++iy)
      for (int ix = rect.x0; ix < rect.x1; ++ix) {
        const Vec2 p = centre(site, ix, iy) - a.head<2>();
        const double u = (p.x() * c.y() - p.y() * c.x()) / twice,
                     v = (b.x() * p.y() - b.y() * p.x()) / twice;
        // A centre on an edge belongs to both faces, which agree there; rounding must not open a
        // seam.
        if (u < -1e-9 || v < -1e-9 || u + v > 1 + 1e-9) continue;
        value(out, ix, iy) = static_cast<float>(a.z() + u * b.z() + v * c.z());
        any = true;
      }
  }
  if (any) return out;
  const Vec2 corner = shift.head<2>() + site.origin(),
             size = site.cell() * Vec2(site.nx(), site.ny());
  const auto meets_site = [&](const Vec2& from, const Vec2& to) {
    return (from.array() < (corner + size).array()).all() && (to.array() > corner.array()).all();
  };
  // These two answers only serve the remedy.
  const bool there = meets_site(low.head<2>(), high.head<2>());
  const bool swapped = meets_site({low.y(), low.x()}, {high.y(), high.x()});
  fail(tin.file, 0, span_text(low.head<2>(), high.head<2>()),
       "the surface '" + tin.name + "' covers no column of the site, which reaches over " +
           span_text(corner, corner + size) + " [m]",
       there ? "its faces have no area, or are smaller than a column: look at linearUnit"
       : swapped
           ? "northing and easting are swapped: LandXML's points are northing easting elevation"
           : "give both in the same coordinates and check the unit; a procedural site counts in W");
}

// --- Areas.

struct Nearest {
  bool inside = false;
  double distance = 0;  ///< to the polygon's edge [m]
  Vec2 place;           ///< there
};

// Finds the nearest point on the edge of a polygon, and whether p is inside (even-odd rule).
Nearest nearest(const std::vector<Vec2>& polygon, const Vec2& p) {
  Nearest out;
  double least = INFINITY;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const Vec2 edge = b - a;
    const Vec2 q = a + edge * std::clamp((p - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    if ((p - q).squaredNorm() < least) {
      least = (p - q).squaredNorm();
      out.place = q;
    }
    // Counts the edges that cross the ray from p towards +x.
    if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < a.x() + edge.x() * (p.y() - a.y()) / edge.y())
      out.inside = !out.inside;
  }
  out.distance = std::sqrt(least);
  return out;
}

/// One area on the columns of a rectangle; kNone where it has no height.
DesignSurface of_area(const scene::DesignArea& area, const Terrain& site, const CellRect& rect,
                      double floor, DesignSurface& floors) {
  DesignSurface sides = nowhere(rect);
  // `down` is the fall of the floor per metre along x and y.
  const Vec2 down = std::tan(area.fall) * Vec2(std::cos(area.fall_yaw), std::sin(area.fall_yaw));
  // From 89.99 deg on a side is vertical and covers no column.
  const bool upright = area.batter > radians(89.99), pit = area.depth > 0;
  const double rise = upright ? 0 : std::tan(area.batter);
  for (int iy = rect.y0; iy < rect.y1; ++iy)
    for (int ix = rect.x0; ix < rect.x1; ++ix) {
      const Vec2 p = centre(site, ix, iy);
      const Nearest at = nearest(area.polygon, p);
      // Outside, the side rises from the floor's height at the nearest point of the edge.
      const double base = floor - down.dot((at.inside ? p : at.place) - area.polygon[0]);
      if (at.inside) {
        value(floors, ix, iy) = static_cast<float>(base);
      } else if (!upright) {
        const double z = base + (pit ? 1 : -1) * at.distance * rise,
                     ground = site.start_height(ix, iy);
        // Sides end where they meet the ground.
        if (pit ? z < ground : z > ground) value(sides, ix, iy) = static_cast<float>(z);
      }
    }
  return sides;
}

// Returns true when sides reach an edge of the rectangle that is not an edge of the site.
bool touches_edge(const DesignSurface& design, const CellRect& whole) {
  const CellRect& r = design.rect;
  for (int iy = r.y0; iy < r.y1; ++iy)
    for (int ix = r.x0; ix < r.x1; ++ix) {
      const bool open = (ix == r.x0 && r.x0 > whole.x0) || (ix == r.x1 - 1 && r.x1 < whole.x1) ||
                        (iy == r.y0 && r.y0 > whole.y0) || (iy == r.y1 - 1 && r.y1 < whole.y1);
      if (open && known(design.at(ix, iy))) return true;
    }
  return false;
}

/// Adds an area: floors replace earlier heights, sides only where they cut deeper or fill higher.
void add_area(const scene::DesignArea& area, const std::string& file, const Terrain& site,
              DesignSurface& out) {
  Vec2 low = area.polygon[0], high = low;
  for (const Vec2& corner : area.polygon) low = low.cwiseMin(corner), high = high.cwiseMax(corner);
  const Vec2i first = site.column_at(area.polygon[0].x(), area.polygon[0].y());
  if (!site.contains(first.x(), first.y()))
    fail(file, area.line, span_text(low, high),
         "the first corner, where depth_m counts from, is off the site, which reaches over " +
             span_text(site.origin(), site.origin() + site.cell() * Vec2(site.nx(), site.ny())),
         "begin the polygon with a corner on the site");
  const double floor = site.start_height(first.x(), first.y()) - area.depth;
  // The reach of sides depends on the ground there, so the search widens until they end.
  // Sides over level ground end at depth / tan(batter); two cells are for rounding.
  double reach = std::abs(area.depth) / std::tan(area.batter) + 2 * site.cell();
  for (;; reach *= 2) {
    const Vec2 margin = Vec2::Constant(reach);
    const CellRect rect = columns_in(site, low - margin, high + margin);
    DesignSurface floors = nowhere(rect);
    const DesignSurface sides = of_area(area, site, rect, floor, floors);
    if (touches_edge(sides, site.site_rect())) continue;
    CellRect both = out.rect;
    both.include(rect);
    DesignSurface grown = nowhere(both);
    for (int iy = out.rect.y0; iy < out.rect.y1; ++iy)
      for (int ix = out.rect.x0; ix < out.rect.x1; ++ix) value(grown, ix, iy) = out.at(ix, iy);
    for (int iy = rect.y0; iy < rect.y1; ++iy)
      for (int ix = rect.x0; ix < rect.x1; ++ix) {
        float& z = value(grown, ix, iy);
        const float side = sides.at(ix, iy);
        if (known(floors.at(ix, iy))) z = floors.at(ix, iy);
        if (known(side) && (!known(z) || (area.depth > 0 ? side < z : side > z))) z = side;
      }
    out = std::move(grown);
    return;
  }
}

// Later areas lie over earlier ones, in the order of the file.
DesignSurface of_areas(const std::vector<scene::DesignArea>& areas, const std::string& file,
                       const Terrain& site) {
  DesignSurface out;
  for (const scene::DesignArea& area : areas) add_area(area, file, site, out);
  return out;
}

}  // namespace

DesignSurface design_of_area(const scene::DesignArea& area, const Terrain& site,
                             const std::string& file) {
  return of_areas({area}, file, site);
}

std::vector<float> DesignSurface::over(int nx, int ny) const {
  std::vector<float> out(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny), kNone);
  for (int iy = rect.y0; iy < rect.y1; ++iy)
    for (int ix = rect.x0; ix < rect.x1; ++ix)
      out[static_cast<std::size_t>(iy) * static_cast<std::size_t>(nx) +
          static_cast<std::size_t>(ix)] = at(ix, iy);
  return out;
}

std::optional<DesignSurface> make_design(const scene::Scene& scene, const Terrain& site) {
  const scene::Design design = scene.commanded_design();
  if (!design.any()) return std::nullopt;
  if (design.tin) return of_tin(*design.tin, site);
  if (design.file.empty()) return of_areas(design.areas, scene.file, site);
  return import_design(scene, design, site);
}

// One pass over the columns with a design; columns without one do not count.
DesignComparison against_design(const Terrain& ground, const DesignSurface& design) {
  DesignComparison out;
  const double square = ground.cell() * ground.cell();
  const auto add = [&](double difference, double& above, double& below) {
    (difference > 0 ? above : below) += std::abs(difference) * square;
  };
  std::int64_t columns = 0;
  for (int iy = design.rect.y0; iy < design.rect.y1; ++iy)
    for (int ix = design.rect.x0; ix < design.rect.x1; ++ix) {
      const auto wanted = static_cast<double>(design.at(ix, iy));
      if (wanted != wanted) continue;
      const double z = ground.height(ix, iy), start = ground.start_height(ix, iy),
                   error = z - wanted;
      ++columns;
      add(start - wanted, out.design_cut, out.design_fill);
      add(z - start, out.fill, out.cut);
      add(error, out.under_dig, out.over_dig);
      out.mean_error += error;
      out.mean_size += std::abs(error);
      if (std::abs(error) > std::abs(out.largest_error)) out.largest_error = error;
    }
  out.area = static_cast<double>(columns) * square;
  out.mean_error /= std::max<double>(1, static_cast<double>(columns));
  out.mean_size /= std::max<double>(1, static_cast<double>(columns));
  return out;
}

}  // namespace navvy::heightfield
