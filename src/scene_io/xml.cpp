// SPDX-License-Identifier: Apache-2.0
#include "scene_io/xml.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <system_error>

#include "core/edit_distance.h"
#include "core/file.h"
#include "core/limits.h"
#include "core/log.h"
#include "core/renamed_names.h"
#include "core/utf8.h"
#include "scene_io/foreign.h"
#include "scene_io/xml_limits.h"

namespace navvy::scene_io {

namespace {
/// Returns the start of a value, which is enough to find it, on one line.
std::string shown(const std::string& value) {
  constexpr std::size_t kMost = 80;
  std::string text = value.size() > kMost ? value.substr(0, kMost - 3) : value;
  // The cut may have split a character; a file is valid UTF-8 otherwise.
  if (text.size() < value.size()) text.resize(std::min(first_bad_utf8(text), text.size()));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\t'; }, ' ');
  return text.size() < value.size() ? text + "..." : text;
}
}  // namespace

void Faults::add_at(Fault::Severity severity, const Element& at, const std::string& value,
                    const std::string& rule, const std::string& remedy) {
  if (!count(severity)) return;
  Fault fault;
  fault.severity = severity;
  const Place place = place_of(at);
  fault.line = place.line;
  fault.file = place.file ? *place.file : "command line";
  fault.element = element_path(at);
  fault.value = shown(value);
  fault.rule = rule;
  fault.remedy = remedy;
  list_.push_back(std::move(fault));
}

void Faults::error(const Element& at, const std::string& value, const std::string& rule,
                   const std::string& remedy) {
  // Ancestors count as faulty too, so that a rule for a whole element can ask about that element.
  for (const tinyxml2::XMLNode* up = &at; up != nullptr && up->ToElement(); up = up->Parent())
    faulty_.insert(up->ToElement());
  add_at(Fault::Severity::kError, at, value, rule, remedy);
}

void Faults::warning(const Element& at, const std::string& value, const std::string& rule,
                     const std::string& remedy) {
  add_at(Fault::Severity::kWarning, at, value, rule, remedy);
}

std::string Faults::nearest(const std::string& word,
                            const std::vector<std::string>& candidates) const {
  // The candidates of a fault that is not shown need not be compared.
  if (errors_.all >= limits::kFaultsShown) return "";
  std::string out = suggestion(word, candidates);
  // A list of all candidates is shown once.
  if (out.rfind("known here", 0) == 0 && !listed_.insert(out).second)
    return "not one of those listed above";
  return out;
}

void Faults::add(Fault fault) {
  if (count(fault.severity)) list_.push_back(std::move(fault));
}

bool Faults::count(Fault::Severity severity) {
  Counted& counts = counted(severity);
  if (++counts.all <= limits::kFaultsShown) return true;
  if (counts.all == limits::kFaultsShown + 1) {
    counts.rest_at = list_.size();
    list_.push_back({severity, "", 0, "", "", "", "correct those above first"});
  }
  // The one entry for the rest is rewritten at each further fault, so the list never grows again.
  list_[counts.rest_at].rule =
      "and " + std::to_string(counts.all - limits::kFaultsShown) + " more that are not shown";
  return false;
}

// Errors are thrown with the warnings, so that a file can be corrected in one go.
void Faults::finish() const {
  if (has_errors()) throw InputError(list_);
  for (const Fault& fault : list_) log_warning(fault.text());
}

std::unique_ptr<Document> Document::open(const std::string& file, Faults& faults) {
  Fault fault;
  fault.file = file;
  // A file that cannot be read counts as well: each attempt costs a call to the system.
  ++faults.work.files;
  try {
    const std::vector<char> bytes = read_file(file, limits::kXmlBytes);
    faults.work.bytes += bytes.size();
    if (faults.work.bytes > limits::kSceneBytes) {
      fault.rule = "the files of a scene may have at most " + std::to_string(limits::kSceneBytes) +
                   " bytes together";
      fault.remedy = "split the scene, or name fewer soils and machines";
      faults.add(fault);
      return nullptr;
    }
    return parse(std::string(bytes.begin(), bytes.end()), file, faults);
    // A file that another one names may be missing.
  } catch (const FileError& failure) {
    // Any failure to read has this type; the size shows whether it was the limit.
    std::error_code unknown;
    const std::uintmax_t bytes = std::filesystem::file_size(file, unknown);
    if (!unknown && bytes > limits::kXmlBytes) {
      fault = too_large(file, static_cast<std::size_t>(bytes));
    } else {
      fault.rule = std::string("cannot be read: ") + failure.what();
      fault.remedy = "check the path";
    }
    faults.add(fault);
    return nullptr;
  }
}

std::unique_ptr<Document> Document::parse(const std::string& text, const std::string& name,
                                          Faults& faults) {
  if (!check_text(text, name, faults)) return nullptr;
  std::unique_ptr<Document> document(new Document);
  document->file_ = name;
  // Elements know their tinyxml2 document only; the user data leads to this object.
  document->xml_.SetUserData(document.get());
  document->xml_.Parse(text.data(), text.size());
  Fault fault;
  fault.file = name;
  if (document->xml_.Error()) {
    fault.line = document->xml_.ErrorLineNum();
    fault.rule =
        std::string("the file must be well-formed XML, but: ") + document->xml_.ErrorName();
    fault.remedy = "look for an unclosed or misspelt tag at or before this line";
    faults.add(fault);
    return nullptr;
  }
  if (!document->root()) {
    fault.rule = "the file has no element";
    fault.remedy = "start with <sdf version=\"1.9\">";
    faults.add(fault);
    return nullptr;
  }
  // Before check_tree, which looks up limits by the current names.
  rename_old(*document->root());
  if (!check_tree(*document->root(), faults)) return nullptr;
  if (!import_document(*document, faults)) return nullptr;
  // Counted in the text like the limit; tags in comments are included.
  document->elements_ = count_elements(text);
  faults.work.elements += document->elements_;
  return document;
}

/// Gives elements and values with names of earlier releases their current ones.
void Document::rename_old(Element& element, int depth) {
  // check_tree reports deeper elements.
  if (depth > static_cast<int>(limits::kXmlNesting)) return;
  const Place place = place_of(element);
  const std::string file = place.file != nullptr ? *place.file : "";
  if (const std::string now = current_name(NameKind::kElement, element.Name(), file, place.line);
      now != element.Name())
    element.SetName(now.c_str());
  for (const auto* at = element.FirstAttribute(); at; at = at->Next()) {
    const std::string key = element.Name() + std::string("/") + at->Name() + "=" + at->Value();
    if (const std::string now = current_name(NameKind::kAttributeValue, key, file, place.line);
        now != key)
      element.SetAttribute(at->Name(), now.substr(now.rfind('=') + 1).c_str());
  }
  for (Element* e = element.FirstChildElement(); e; e = e->NextSiblingElement())
    rename_old(*e, depth + 1);
}

Place place_of(const Element& element) {
  // A copied element knows where its original was written.
  if (const void* known = element.GetUserData()) return *static_cast<const Place*>(known);
  // tinyxml2 counts parsed lines from 1; elements of overrides have line 0.
  if (element.GetLineNum() > 0) return {&Document::of(element).file(), element.GetLineNum()};
  return {};
}

Element* Document::create(const char* name, const Element& from) {
  Element* element = xml_.NewElement(name);
  Place place = place_of(from);
  // The name of the file must outlive its document.
  // The document of a part is closed before later checks report its elements.
  if (place.file != nullptr) place.file = &*other_files_.insert(*place.file).first;
  element->SetUserData(&places_.emplace_back(place));
  return element;
}

void Document::replace_root(Element& root) {
  xml_.DeleteChild(xml_.RootElement());
  xml_.InsertEndChild(&root);
}

void Document::append_copy(Element& parent, const Element& from) {
  auto& owner = *static_cast<Document*>(parent.GetDocument()->GetUserData());
  Element* to = owner.create(from.Name(), from);
  parent.InsertEndChild(to);
  for (const auto* at = from.FirstAttribute(); at; at = at->Next())
    to->SetAttribute(at->Name(), at->Value());
  for (const auto* node = from.FirstChild(); node; node = node->NextSibling()) {
    if (const Element* child = node->ToElement())
      append_copy(*to, *child);
    else if (node->ToText())
      to->InsertEndChild(node->DeepClone(to->GetDocument()));
  }
}

const Document& Document::of(const Element& element) {
  // The pointer was set when the document was parsed.
  return *static_cast<const Document*>(element.GetDocument()->GetUserData());
}

std::string Document::directory() const {
  // A bare file name is in the working directory.
  const std::string directory = std::filesystem::path(file_).parent_path().string();
  return directory.empty() ? "." : directory;
}

std::string Document::text() const {
  tinyxml2::XMLPrinter printer;
  xml_.Print(&printer);
  return printer.CStr();
}

namespace {
std::string label(const Element& element) {
  std::string name = element.Name();
  // These attributes identify elements of one kind in scenes.
  for (const char* key : {"name", "ref", "joint"})
    if (const char* value = element.Attribute(key)) return name + "[" + value + "]";
  // Without a name, the place among equal siblings identifies it.
  int place = 1, count = 0;
  // The outermost element has no siblings.
  const auto* parent = element.Parent() ? element.Parent()->ToElement() : nullptr;
  if (!parent) return name;
  for (const Element* other = parent->FirstChildElement(element.Name()); other;
       other = other->NextSiblingElement(element.Name())) {
    ++count;
    if (other == &element) place = count;
  }
  return count > 1 ? name + "[" + std::to_string(place) + "]" : name;
}
}  // namespace

std::string element_path(const Element& element) {
  if (std::strcmp(element.Name(), "world") == 0) return "world";
  std::string path = label(element);
  // There is one world and one root, so paths leave them out.
  for (const auto* up = element.Parent(); up && up->ToElement(); up = up->Parent()) {
    const Element& parent = *up->ToElement();
    if (std::strcmp(parent.Name(), "sdf") == 0) break;
    path = (std::strcmp(parent.Name(), "world") == 0 ? std::string("world") : label(parent)) + "/" +
           path;
  }
  return path;
}

const Element* named_child(const Element& parent, const char* kind, const std::string& name) {
  for (const Element* child = parent.FirstChildElement(kind); child;
       child = child->NextSiblingElement(kind))
    if (attribute(*child, "name") == name) return child;
  return nullptr;
}

std::string text_of(const Element& element) {
  std::string text;
  // Comments and elements split a text into several nodes.
  for (const auto* node = element.FirstChild(); node; node = node->NextSibling())
    if (node->ToText()) text += node->Value();
  const char* blank = " \t\r\n";
  const auto first = text.find_first_not_of(blank);
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

std::string child_text(const Element& element, const char* name) {
  const Element* child = element.FirstChildElement(name);
  return child ? text_of(*child) : "";
}

std::string attribute(const Element& element, const char* name) {
  const char* value = element.Attribute(name);
  return value ? value : "";
}

bool is_extension(const Element& element) { return std::strncmp(element.Name(), "navvy:", 6) == 0; }

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

bool to_number(const std::string& text, double& value) {
  // std::stod would follow the locale of the process. from_chars takes no plus sign, which files
  // may have.
  const char* first = text.data();
  const char* last = first + text.size();
  if (first != last && *first == '+') {
    ++first;
    // "+-5" would be read as -5.
    if (first != last && *first == '-') return false;
  }
  const auto result = std::from_chars(first, last, value);
  return result.ec == std::errc() && result.ptr == last && first != last;
}

}  // namespace navvy::scene_io
