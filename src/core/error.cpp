// SPDX-License-Identifier: Apache-2.0
#include "core/error.h"

#include <utility>

#include "core/printable.h"

namespace navvy {

std::string Fault::text() const {
  // The format of compilers, `file:line: error:`, which editors turn into links. Unknown parts
  // leave no trace, not even a separator.
  std::string out;
  if (!file.empty()) {
    out += file;
    if (line > 0) out += ":" + std::to_string(line);
    out += ": ";
  }
  out += severity == Severity::kError ? "error: " : "warning: ";
  if (!element.empty()) out += element + ": ";
  if (!value.empty()) out += "'" + value + "': ";
  out += rule;
  if (!remedy.empty()) out += " (" + remedy + ")";
  // Paths, names and values come from files of any origin.
  return printable(out);
}

namespace {
/// Returns the texts of all faults, one per line.
std::string join(const std::vector<Fault>& faults) {
  std::string out;
  // A person sees all faults at once and can correct them in one pass.
  for (const Fault& fault : faults) {
    if (!out.empty()) out += "\n";
    out += fault.text();
  }
  return out;
}
}  // namespace

InputError::InputError(std::vector<Fault> faults)
    : Error(join(faults)), faults_(std::move(faults)) {}
InputError::InputError(Fault fault) : InputError(std::vector<Fault>{std::move(fault)}) {}

}  // namespace navvy
