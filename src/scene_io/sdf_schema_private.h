// SPDX-License-Identifier: Apache-2.0
// Description of SDF by libsdformat, reduced to the elements that Navvy reads.
#pragma once

#include <sdf/sdf.hh>
#include <string>

namespace navvy::scene_io {

/// Parses a text of one <model> into `root`. libsdformat parses its whole description of SDF, some
/// 7000 elements, for every text; here the description is parsed once per process and reduced to
/// the used elements, so that a model takes milliseconds. Safe to call from several threads.
///
/// @returns the faults that libsdformat finds. @throws std::bad_alloc, sdf::Exception and others
sdf::Errors parse_model(const std::string& text, sdf::Root& root);

}  // namespace navvy::scene_io
