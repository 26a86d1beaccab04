// SPDX-License-Identifier: Apache-2.0
// Surfaces of LandXML 1.2, as survey programs write them.
#pragma once

#include <string>

#include "scene/design.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Returns true if the root of the file is <LandXML>; false if it cannot be read.
bool is_landxml(const std::string& file);

/// Reads one TIN of `file`: points (northing easting elevation) and the visible faces, in metres.
/// The unit is that of Metric or Imperial (millimeter, centimeter, meter, kilometer, foot,
/// USSurveyFoot, inch, mile), for elevations too. `surface` is its name; empty: the only one. It
/// takes some 100 bytes per point or face while reading.
///
/// Reports a missing or unknown unit, a missing surface, one that is no TIN, a point without id or
/// number, a repeated id, a face to a missing point, and a surface without a visible face. Returns
/// null after a fault.
std::shared_ptr<const scene::Tin> read_landxml(const std::string& file, const std::string& surface,
                                               Faults& faults);

}  // namespace navvy::scene_io
