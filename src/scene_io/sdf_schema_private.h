// SPDX-License-Identifier: Apache-2.0
// Parses models with libsdformat, using a reduced description of SDF.
#pragma once

#include <sdf/sdf.hh>
#include <string>

namespace navvy::scene_io {

/// Parses a text that contains one <model> into `root`. For every text, libsdformat itself would
/// parse its complete description of SDF with about 7000 elements. This function parses the
/// description once per process and reduces it to the elements that Navvy uses, so that reading a
/// model takes milliseconds. It may be called from several threads.
///
/// @returns the errors that libsdformat finds. @throws std::bad_alloc, sdf::Exception and others
sdf::Errors parse_model(const std::string& text, sdf::Root& root);

}  // namespace navvy::scene_io
