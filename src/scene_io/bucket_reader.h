// SPDX-License-Identifier: Apache-2.0
// Buckets that are made of plates by the numbers of a data sheet, and bucket files.
#pragma once

#include <string>

#include "scene/machine.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Copies the values of the bucket file that the attribute `ref` of a <navvy:bucket> names, and
/// that are missing in the element, into the element. A bucket file is buckets/NAME.sdf in a data
/// directory, or a path that ends in .sdf and counts from the file of the element. Has no effect
/// without `ref`.
void fill_in_bucket(Element& bucket, Faults& faults);

/// Checks the <navvy:bucket> elements of a model, which have been read into `machine.buckets`, and
/// makes those without <shell>: their link gets mass, centre of mass and inertia of the plates, a
/// picture and a shell in place of what it had, and no collision shape. A bucket that the file has
/// for the same link is replaced, and gives place, opening and name of the shell. A sentence about
/// each is added to `machine.derived`.
void make_buckets(Element& model, scene::Machine& machine, Faults& faults);

/// Makes `asked`, read from the <navvy:bucket> of an <include>, in place of the bucket of
/// `machine`.
void fit_bucket(const Element& element, const scene::Bucket& asked, scene::Machine& machine,
                Faults& faults);

/// Reports if the teeth of a bucket are wider than its cutting edge.
void check_teeth(const Element& element, const scene::Bucket& bucket, Faults& faults);

/// Returns true if a <navvy:bucket> of the model makes the mass of this link.
bool bucket_weighs(const Element& model, const std::string& link);

/// Reads a bucket file and reports its faults.
void check_bucket_file(Document& document, Faults& faults);

}  // namespace navvy::scene_io
