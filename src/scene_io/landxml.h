// SPDX-License-Identifier: Apache-2.0
// Reads surfaces from LandXML 1.2 files, which survey programs write.
#pragma once

#include <string>

#include "scene/design.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Returns true if the root element of the file is <LandXML>; false if it is another element or the
/// file cannot be read.
bool is_landxml(const std::string& file);

/// Reads one TIN (triangulated surface) of `file`: its points, given as northing easting elevation,
/// and its visible faces. Coordinates and elevations are converted to metres from the unit in the
/// element Metric or Imperial (millimeter, centimeter, meter, kilometer, foot, USSurveyFoot, inch,
/// mile). `surface` is the name of the surface to read; empty: the only surface of the file.
/// Reading takes about 100 bytes of memory per point or face.
///
/// Reports as errors: a missing or unknown unit, a missing surface, a surface that is not a TIN, a
/// point without ID or with invalid numbers, a repeated ID, a face with a nonexistent point, and a
/// surface without visible faces. Returns null after an error.
std::shared_ptr<const scene::Tin> read_landxml(const std::string& file, const std::string& surface,
                                               Faults& faults);

}  // namespace navvy::scene_io
