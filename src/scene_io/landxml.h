// SPDX-License-Identifier: Apache-2.0
// LandXML 1.2 surfaces as surveyors' programs write them.
#pragma once

#include <string>

#include "scene/design.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// By its root element. False where it cannot be read.
bool is_landxml(const std::string& file);

/// Reads one TIN of `file`: points (northing easting elevation) and the faces that are not
/// invisible (i="1"), in metres. Unit is Metric's or Imperial's linearUnit (millimeter, centimeter,
/// meter, kilometer, foot, USSurveyFoot, inch, mile), for elevations too. `surface` names it;
/// empty: the only one there is. Costs some 100 bytes a point or face while it is read.
///
/// Faults go to the list with file, line, value and remedy: no unit or an unknown one, a surface
/// that is missing or no TIN, a point without id or number, an id twice, a face to a point that is
/// not there, no visible face; nothing is returned then.
std::shared_ptr<const scene::Tin> read_landxml(const std::string& file, const std::string& surface,
                                               Faults& faults);

}  // namespace navvy::scene_io
