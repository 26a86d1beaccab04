// SPDX-License-Identifier: Apache-2.0
// libsdformat's own description of SDF, cut down to what Navvy reads.
#pragma once

#include <sdf/sdf.hh>
#include <string>

namespace navvy::scene_io {

/// Parses a text of one <model>, of elements that `is_used_sdf` lets through, into `root`.
/// libsdformat parses its whole description of SDF for every text and copies the part below each
/// element that it reads, some 7000 elements; here the description is parsed once a process and cut
/// down to the seventy that are used, which is what makes reading a model cost milliseconds.
/// Threads may call it side by side.
/// @throws std::bad_alloc, sdf::Exception and what else libsdformat throws; what it finds wrong is
/// returned.
sdf::Errors parse_model(const std::string& text, sdf::Root& root);

}  // namespace navvy::scene_io
