// SPDX-License-Identifier: Apache-2.0
#include "scene_io/sdf_schema_private.h"

#include "scene_io/sdf_rules.h"

namespace navvy::scene_io {

namespace {

// Returns the description of `from` with the used elements below it.
sdf::ElementPtr cut_down(const sdf::ElementPtr& from) {
  auto to = std::make_shared<sdf::Element>();
  to->SetName(from->GetName());
  to->SetRequired(from->GetRequired());
  for (std::size_t i = 0; i < from->GetAttributeCount(); ++i) {
    const sdf::ParamPtr at = from->GetAttribute(static_cast<unsigned>(i));
    to->AddAttribute(at->GetKey(), at->GetTypeName(), at->GetDefaultAsString(), at->GetRequired());
  }
  if (const sdf::ParamPtr value = from->GetValue()) {
    const auto least = value->GetMinValueAsString(), most = value->GetMaxValueAsString();
    to->AddValue(value->GetTypeName(), value->GetDefaultAsString(), value->GetRequired(),
                 least.value_or(""), most.value_or(""));
  }
  for (std::size_t i = 0; i < from->GetElementDescriptionCount(); ++i) {
    const sdf::ElementPtr below = from->GetElementDescription(static_cast<unsigned>(i));
    if (is_used_sdf(from->GetName().c_str(), below->GetName().c_str()))
      to->AddElementDescription(cut_down(below));
  }
  return to;
}

const sdf::ElementPtr& description() {
  static const sdf::ElementPtr once = [] {
    const auto whole = std::make_shared<sdf::SDF>();
    sdf::init(whole);
    return cut_down(whole->Root());
  }();
  return once;
}

}  // namespace

sdf::Errors parse_model(const std::string& text, sdf::Root& root) {
  sdf::ParserConfig config;
  // check_sdf lets through only what is understood, so a warning means a misreading.
  config.SetWarningsPolicy(sdf::EnforcementPolicy::ERR);
  config.SetUnrecognizedElementsPolicy(sdf::EnforcementPolicy::ERR);
  const auto document = std::make_shared<sdf::SDF>();
  // Reading changes the description, so every text gets a copy.
  document->Root(description()->Clone());
  sdf::Errors errors;
  if (!sdf::readString(text, config, document, errors)) {
    if (errors.empty())
      errors.emplace_back(sdf::ErrorCode::STRING_READ, "the model cannot be read");
    return errors;
  }
  const sdf::Errors found = root.Load(document, config);
  errors.insert(errors.end(), found.begin(), found.end());
  return errors;
}

}  // namespace navvy::scene_io
