// SPDX-License-Identifier: Apache-2.0
#include "scene/fields.h"

#include <charconv>
#include <cstdio>
#include <iterator>

namespace navvy::scene {
namespace {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
// Clang 14 deduces no arguments of an aggregate.
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

struct Suffix {
  std::string_view end;
  Unit unit;
};
// Longer suffixes come before those that they end in. The two exponents of Bekker's law are names.
constexpr Suffix kSuffixes[] = {
    {"bekker_n", {"-", 1}},
    {"_kg_per_m3", {"kg/m3", 1}},
    {"_m3_per_s", {"m3/s", 1}},
    {"_n_per_m_n1", {"N/m^(n+1)", 1}},
    {"_n_per_m_n2", {"N/m^(n+2)", 1}},
    {"_n_per_m", {"N/m", 1}},
    {"_n_s_per_m", {"N s/m", 1}},
    {"_m_per_n", {"m/N", 1}},
    {"_m_per_s", {"m/s", 1}},
    {"_deg_per_s", {"deg/s", kDegree}},
    {"_deg", {"deg", kDegree}},
    {"_rpm", {"rpm", 2 * kPi / 60}},
    {"_pa", {"Pa", 1}},
    {"_hz", {"1/s", 1}},
    {"_px", {"pixels", 1}},
    {"_nm", {"N m", 1}},
    {"_m3", {"m3", 1}},
    {"_kg", {"kg", 1}},
    {"_n", {"N", 1}},
    {"_w", {"W", 1}},
    {"_s", {"s", 1}},
    {"_m", {"m", 1}},
};

/// Does nothing with any field; base of visitors that look for one kind.
class Ignoring : public Fields {
 public:
  void field(const Field&) override {}
  void group(const Group&, const std::function<void(Fields&)>&) override {}
  void list(const List&) override {}
  void types(const Types&) override {}
};

/// Collects the numbers of a struct, without those of child elements, which have lists of their
/// own.
class NumberFinder final : public Ignoring {
 public:
  void field(const Field& f) override {
    if (double* const* value = std::get_if<double*>(&f.value); value && !f.mark.has(Mark::kDerived))
      found.push_back({f.name, *value, f.range.min, f.range.max, unit_of(f.name).factor,
                       !f.mark.has(Mark::kShown)});
  }
  std::vector<NamedNumber> found;
};

/// Finds the name of an item: its own, or as a second choice the first name that it refers to.
class NameFinder final : public Ignoring {
 public:
  void field(const Field& f) override {
    std::string* const* value = std::get_if<std::string*>(&f.value);
    if (value == nullptr) return;
    const bool named = f.mark.has(Mark::kAttribute) || std::string_view(f.name) == "name";
    if (named && name.empty()) name = **value;
    if (reference.empty() && f.refers != Refers::kNothing) reference = **value;
  }
  std::string name, reference;
};

}  // namespace

Unit unit_of(std::string_view name) {
  for (const Suffix& suffix : kSuffixes)
    if (name.ends_with(suffix.end)) return suffix.unit;
  return {"-", 1};
}

std::string short_text(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

std::string exact_text(double in_si, double factor) {
  char text[40];
  // Adding zero turns -0 into 0, which is equivalent in every run.
  const double value = (in_si + 0.0) / factor;
  // Few digits are tried first, so that 30 deg is not written with the rounding of its conversion.
  for (const int digits : {12, 15, 16, 17}) {
    const auto end = std::to_chars(text, std::end(text), value, std::chars_format::general, digits);
    double back = 0;
    std::from_chars(text, end.ptr, back);
    if (back * factor == in_si) return {text, end.ptr};
  }
  // A value that no text in the file's unit gives is written in SI units.
  const auto end = std::to_chars(text, std::end(text), in_si);
  return std::string(text, end.ptr) + (factor != 1 ? " (SI)" : "");
}

std::string value_text(const Value& value, double factor) {
  const auto numbers = [factor](const auto* data, std::size_t size) {
    std::string all;
    for (std::size_t i = 0; i < size; ++i)
      all += (i == 0 ? "" : " ") + exact_text(static_cast<double>(data[i]), factor);
    return all;
  };
  return std::visit(
      Overloaded{[](const bool* v) { return std::string(*v ? "true" : "false"); },
                 [](const int* v) { return std::to_string(*v); },
                 [](const std::uint64_t* v) { return std::to_string(*v); },
                 [&](const double* v) { return exact_text(*v, factor); },
                 [](const std::string* v) { return *v; },
                 [&](const Vec2* v) { return numbers(v->data(), 2); },
                 [&](const Vec3* v) { return numbers(v->data(), 3); },
                 [&](const Mat3* v) { return numbers(v->data(), 9); },
                 [&](const std::vector<double>* v) { return numbers(v->data(), v->size()); },
                 [&](const std::vector<Vec3>* v) {
                   // A vector of three doubles has no padding, so the points are one run of
                   // numbers.
                   return numbers(reinterpret_cast<const double*>(v->data()), 3 * v->size());
                 },
                 [](const std::optional<int>* v) { return *v ? std::to_string(**v) : "none"; },
                 [&](const Direction& v) { return numbers(v.value->data(), 3); },
                 [&](const Rgb& v) { return numbers(v.value, 3); },
                 [](const NamedChoice& v) { return std::string(v.names.at(v.get())); },
                 [](const Computed& v) { return v(); }, [](const Pose*) { return std::string(); }},
      value);
}

std::vector<NamedNumber> numbers_of(const std::function<void(Fields&)>& describe) {
  NumberFinder finder;
  describe(finder);
  return finder.found;
}

std::string name_of(const std::function<void(Fields&)>& describe) {
  NameFinder finder;
  describe(finder);
  return finder.name.empty() ? finder.reference : finder.name;
}

}  // namespace navvy::scene
