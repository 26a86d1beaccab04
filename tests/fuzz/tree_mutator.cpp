// SPDX-License-Identifier: Apache-2.0
// Mutations of XML for libFuzzer, whose own mutations change bytes: nearly all of them are no XML,
// so that the readers behind the parser never see them. Here elements are removed, copied, moved,
// renamed and given other values, and trees of two inputs are crossed. One mutation in eight
// changes bytes, since input that is no XML must be refused too.
#include <tinyxml2.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "core/random.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

/// Values at and beyond the limits of readers, and keywords.
const char* const kValues[] = {
    "",          "0",        "-0",          "1",        "-1",    "2",
    "3",         "0.5",      "1e-9",        "1e9",      "1e308", "1e400",
    "-1e300",    "1e-320",   "nan",         "inf",      "-inf",  "255",
    "256",       "65536",    "2147483648",  "-5",       "1e16",  "18446744073709551615",
    "true",      "false",    "0 0",         "1 2 3",    "0 0 0", "0 0 1",
    "world",     "settle",   "1 0 0 0 0 0", "\xc3\xa9", "a,b",   "../x",
    "/dev/zero", "slide.sdf"};

std::size_t below(navvy::Random& random, std::size_t count) {
  return count == 0 ? 0 : static_cast<std::size_t>(random.next() % count);
}

template <class List>
const auto& any_of(navvy::Random& random, const List& list) {
  return list[below(random, std::size(list))];
}

std::vector<XMLElement*> elements_of(XMLDocument& tree) {
  std::vector<XMLElement*> all;
  if (tree.RootElement() != nullptr) all.push_back(tree.RootElement());
  for (std::size_t i = 0; i < all.size() && i < 5000; ++i)
    for (XMLElement* child = all[i]->FirstChildElement(); child;
         child = child->NextSiblingElement())
      all.push_back(child);
  return all;
}

/// Names of all elements seen in this process, from which new elements take theirs.
std::vector<std::string>& names() {
  static std::vector<std::string> seen = {"navvy:joint"};
  return seen;
}

void learn(const std::vector<XMLElement*>& elements) {
  for (const XMLElement* element : elements)
    if (names().size() < 600 && std::strlen(element->Name()) < 40 &&
        std::find(names().begin(), names().end(), element->Name()) == names().end())
      names().emplace_back(element->Name());
}

/// Replaces the whole value, or one of its words.
std::string other_value(navvy::Random& random, const std::string& text) {
  if (below(random, 3) == 0) return any_of(random, kValues);
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  if (words.empty()) return any_of(random, kValues);
  std::string& word = words[below(random, words.size())];
  switch (below(random, 5)) {
    case 0: {
      double number = 0;
      std::istringstream(word) >> number;
      std::ostringstream out;
      out << number * (below(random, 2) == 0 ? -1 : random.uniform(0, 3));
      word = out.str();
      break;
    }
    case 1: {
      char bytes[64] = {};
      const std::size_t size = std::min(word.size(), sizeof bytes);
      std::memcpy(bytes, word.data(), size);
      word.assign(bytes,
                  LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(bytes), size, sizeof bytes));
      break;
    }
    case 2:
      words.push_back(words[below(random, words.size())]);
      break;
    case 3:
      words.pop_back();
      break;
    default:
      word = any_of(random, kValues);
  }
  std::string out;
  for (const std::string& one : words) out += (out.empty() ? "" : " ") + one;
  return out;
}

void change_attribute(navvy::Random& random, XMLElement& element,
                      const std::vector<XMLElement*>& all) {
  const XMLElement& other = *any_of(random, all);
  const tinyxml2::XMLAttribute* from = other.FirstAttribute();
  const tinyxml2::XMLAttribute* own = element.FirstAttribute();
  // Copied, as it may be the attribute's own value.
  if (from != nullptr && below(random, 2) == 0)
    element.SetAttribute(own != nullptr ? own->Name() : from->Name(),
                         std::string(from->Value()).c_str());
  else if (own != nullptr && below(random, 2) == 0)
    element.DeleteAttribute(own->Name());
  else if (own != nullptr)
    element.SetAttribute(own->Name(), other_value(random, own->Value()).c_str());
}

void change(navvy::Random& random, XMLDocument& tree) {
  const std::vector<XMLElement*> all = elements_of(tree);
  learn(all);
  XMLElement& element = *any_of(random, all);
  XMLElement& other = *any_of(random, all);
  const bool is_root = &element == tree.RootElement();
  switch (below(random, 10)) {
    case 0:
      if (!is_root) element.Parent()->DeleteChild(&element);
      break;
    case 1:
      if (!is_root) element.Parent()->InsertAfterChild(&element, element.DeepClone(&tree));
      break;
    case 2:
      if (!is_root) other.InsertEndChild(element.DeepClone(&tree));
      break;
    case 3: {
      XMLElement* child = tree.NewElement(any_of(random, names()).c_str());
      child->SetText(any_of(random, kValues));
      element.InsertFirstChild(child);
      break;
    }
    case 4:
      element.SetName(any_of(random, names()).c_str());
      break;
    case 5:
      change_attribute(random, element, all);
      break;
    default:
      // The most frequent case: values are in elements without children.
      for (int tries = 0; tries < 4; ++tries) {
        XMLElement& leaf = *any_of(random, all);
        if (leaf.FirstChildElement() != nullptr) continue;
        const char* text = leaf.GetText();
        leaf.SetText(other_value(random, text != nullptr ? text : "").c_str());
        break;
      }
  }
}

bool parse(XMLDocument& tree, const std::uint8_t* data, std::size_t size) {
  tree.Parse(reinterpret_cast<const char*>(data), size);
  return !tree.Error() && tree.RootElement() != nullptr;
}

/// Writes the tree; returns 0 if it does not fit.
std::size_t print(const XMLDocument& tree, std::uint8_t* data, std::size_t max_size) {
  tinyxml2::XMLPrinter printer(nullptr, true);
  tree.Print(&printer);
  const std::size_t size = static_cast<std::size_t>(printer.CStrSize()) - 1;
  if (size > max_size) return 0;
  std::memcpy(data, printer.CStr(), size);
  return size;
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  navvy::Random random(seed);
  XMLDocument tree;
  if (below(random, 8) == 0 || !parse(tree, data, size))
    return LLVMFuzzerMutate(data, size, max_size);
  for (std::size_t changes = 1 + below(random, 3); changes > 0; --changes) change(random, tree);
  const std::size_t printed = print(tree, data, max_size);
  return printed > 0 ? printed : LLVMFuzzerMutate(data, size, max_size);
}

/// Moves a tree of the second input into the first: beside elements of the same name, or below one
/// of its parent's name.
extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* data1, std::size_t size1,
                                                 const std::uint8_t* data2, std::size_t size2,
                                                 std::uint8_t* out, std::size_t max_size,
                                                 unsigned seed) {
  navvy::Random random(seed);
  XMLDocument to, from;
  if (!parse(to, data1, size1) || !parse(from, data2, size2)) return 0;
  const std::vector<XMLElement*> gifts = elements_of(from), all = elements_of(to);
  learn(gifts);
  const XMLElement& gift = *any_of(random, gifts);
  const auto* parent = gift.Parent() != nullptr ? gift.Parent()->ToElement() : nullptr;
  std::vector<XMLElement*> places;
  for (XMLElement* element : all)
    if (parent != nullptr && std::strcmp(element->Name(), parent->Name()) == 0)
      places.push_back(element);
  XMLElement& place = *any_of(random, places.empty() ? all : places);
  XMLElement* same = place.FirstChildElement(gift.Name());
  if (same != nullptr && below(random, 2) == 0) place.DeleteChild(same);
  place.InsertEndChild(gift.DeepClone(&to));
  return print(to, out, max_size);
}
