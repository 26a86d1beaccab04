// SPDX-License-Identifier: Apache-2.0
#include "scene_io/xml_limits.h"

#include <algorithm>
#include <cstring>

#include "core/limits.h"
#include "core/printable.h"
#include "core/utf8.h"
#include "scene_io/schema.h"

namespace navvy::scene_io {

namespace {

// Every byte of a character beyond ASCII counts, although XML excludes some: the count is a bound.
bool starts_name(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte >= 'a' && byte <= 'z') || (byte >= 'A' && byte <= 'Z') || byte == '_' ||
         byte == ':' || byte >= 0x80;
}

/// XML allows tabs and line breaks as blanks.
bool is_control(char c) {
  // XML 1.0 allows DEL (0x7F); here it is refused, as terminals do not show it.
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t' && c != '\n' && c != '\r') || byte == 0x7F;
}

/// Character references such as "&#0;" can hold what bytes of a file may not.
void check_value(const Element& at, const char* value, Faults& faults) {
  const std::string_view text = value;
  if (first_bad_utf8(text) == std::string_view::npos &&
      std::none_of(text.begin(), text.end(), is_control))
    return;
  faults.error(at, "", "holds a character that is none of Unicode's, or a control character",
               "remove character references such as &#xD800;");
}

/// Checks the number of children of one kind.
bool check_count(const Element& element, const char* child, std::size_t most, Faults& faults) {
  std::size_t found = 0;
  for (const Element* e = element.FirstChildElement(child); e; e = e->NextSiblingElement(child))
    ++found;
  if (found <= most) return true;
  faults.error(
      element, std::to_string(found),
      "at most " + std::to_string(most) + " <" + child + "> in one <" + element.Name() + ">",
      "docs/reference/limits.md lists the limits of files");
  return false;
}

/// Checks how often elements occur. The limits are those that `describe` of each struct states.
bool check_counts(const Element& element, Faults& faults) {
  bool good = true;
  for (const SchemaNode* child : schema().children(element.Name()))
    if (child->repeats)
      good = check_count(element, child->name.c_str(), child->most, faults) && good;
  // Frames belong to SDF alone, the joints of a trajectory to a kind of step.
  if (std::strcmp(element.Name(), "model") == 0)
    good = check_count(element, "frame", limits::kLinks, faults) && good;
  if (std::strcmp(element.Name(), "trajectory") == 0)
    good = check_count(element, "joint", limits::kLinks, faults) && good;
  std::size_t steps = 0;
  // Steps are not in the schema of the loader, so all children of a program count together.
  if (std::strcmp(element.Name(), "navvy:program") == 0)
    for (const Element* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) ++steps;
  if (steps > limits::kSteps) {
    faults.error(element, std::to_string(steps),
                 "a program may have at most " + std::to_string(limits::kSteps) + " steps",
                 "split it between machines, or write a longer path into one step");
    good = false;
  }
  return good;
}

/// Returns false if the rest must not be read, as the readers' work is not bounded. Faults of
/// single values are reported, and reading goes on.
bool check_element(const Element& element, std::size_t depth, Faults& faults) {
  const auto most = [&](const char* what, std::size_t number) {
    faults.error(element, "", std::string("at most ") + std::to_string(number) + " " + what,
                 "docs/reference/limits.md lists the limits of files");
    return false;
  };
  // Reading ends here: names go into messages, and the depth of elements onto the stack.
  if (std::strlen(element.Name()) > limits::kNameBytes)
    return most("bytes in the name of an element", limits::kNameBytes);
  if (depth > limits::kXmlNesting) return most("elements inside each other", limits::kXmlNesting);
  bool good = check_counts(element, faults);
  for (const auto* at = element.FirstAttribute(); at; at = at->Next()) {
    if (std::strlen(at->Name()) > limits::kNameBytes)
      return most("bytes in the name of an attribute", limits::kNameBytes);
    // A faulty name is reported once.
    if (std::strcmp(at->Name(), "name") != 0 || check_name(element, at->Value(), faults))
      check_value(element, at->Value(), faults);
  }
  for (const auto* node = element.FirstChild(); node; node = node->NextSibling()) {
    if (node->ToText()) check_value(element, node->Value(), faults);
    if (const Element* child = node->ToElement())
      good = check_element(*child, depth + 1, faults) && good;
  }
  return good;
}

}  // namespace

std::size_t count_elements(const std::string& text) {
  // The text is counted before it is parsed, as the memory of the parser is what the limit bounds.
  // Tags in comments and CDATA count as well.
  std::size_t count = 0;
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1))
    count += at + 1 < text.size() && starts_name(text[at + 1]) ? 1 : 0;
  return count;
}

std::size_t overloaded_tag(std::string_view text) {
  // Comments, CDATA and processing instructions hold no tags.
  constexpr std::string_view kLeftOut[][2] = {{"<!--", "-->"}, {"<![CDATA[", "]]>"}, {"<?", "?>"}};
  for (std::size_t at = text.find('<'); at < text.size(); at = text.find('<', at)) {
    const std::size_t tag = at++;
    for (const auto& [open, close] : kLeftOut)
      // Without an end the search yields npos, which ends the loop; the parser reports the fault.
      if (text.substr(tag, open.size()) == open) at = text.find(close, tag + open.size());
    if (at != tag + 1) continue;
    std::size_t attributes = 0;
    char quote = 0;
    // '>' and '=' inside quotes are text. Outside of them, each '=' belongs to one attribute.
    for (; at < text.size() && (quote != 0 || text[at] != '>'); ++at) {
      const char c = text[at];
      if (quote != 0)
        quote = c == quote ? 0 : quote;
      else if (c == '"' || c == '\'')
        quote = c;
      else if (c == '=' && ++attributes > limits::kXmlAttributes)
        return tag;
    }
  }
  return std::string_view::npos;
}

Fault too_large(const std::string& file, std::size_t bytes) {
  Fault fault;
  fault.file = file;
  fault.value = std::to_string(bytes) + " bytes";
  fault.rule =
      "a scene, machine or soil file may have at most " + std::to_string(limits::kXmlBytes);
  fault.remedy = "put meshes into OBJ files and machines into files of their own";
  return fault;
}

bool check_text(const std::string& text, const std::string& file, Faults& faults) {
  // The cheap checks come first; each is linear in the size of the text.
  Fault fault;
  fault.file = file;
  if (text.size() > limits::kXmlBytes) {
    fault = too_large(file, text.size());
  } else if (const std::size_t bad = first_bad_utf8(text); bad != std::string_view::npos) {
    fault.line = 1 + static_cast<int>(std::count(
                         text.begin(), text.begin() + static_cast<std::ptrdiff_t>(bad), '\n'));
    fault.rule = "the file must be text in UTF-8";
    fault.remedy = "save it as UTF-8: iconv -f latin1 -t utf-8 OLD > NEW";
  } else if (const std::size_t elements = count_elements(text); elements > limits::kXmlElements) {
    fault.value = std::to_string(elements) + " elements";
    fault.rule = "a file may have at most " + std::to_string(limits::kXmlElements) +
                 ", those in comments too";
    fault.remedy = "split it, or put meshes into OBJ files";
  } else if (const std::size_t tag = overloaded_tag(text); tag != std::string_view::npos) {
    fault.line = 1 + static_cast<int>(std::count(
                         text.begin(), text.begin() + static_cast<std::ptrdiff_t>(tag), '\n'));
    fault.rule = "at most " + std::to_string(limits::kXmlAttributes) + " attributes in one element";
    fault.remedy = "docs/reference/limits.md lists the limits of files";
  } else {
    return true;
  }
  faults.add(fault);
  return false;
}

bool check_tree(const Element& root, Faults& faults) { return check_element(root, 1, faults); }

bool check_name(const Element& at, const std::string& name, Faults& faults) {
  // Text that is not UTF-8 is left to check_value, which reports it.
  std::string rule;
  if (name.size() > limits::kNameBytes)
    rule = "a name may have at most " + std::to_string(limits::kNameBytes) + " bytes";
  else if (name.find_first_of(",\"") != std::string::npos ||
           (first_bad_utf8(name) == std::string::npos && printable(name) != name))
    rule =
        "a name must hold no comma, no quote, no line break and no invisible character: it heads "
        "columns of CSV files";
  else if (!name.empty() && std::strchr("=+-@ ", name.front()) != nullptr)
    rule =
        "a name must not begin with = + - @ or a blank: it heads columns of CSV files, which "
        "spreadsheets would run as a formula";
  if (rule.empty()) return true;
  faults.error(at, name, rule, "use letters, digits, blanks, _ and -, and begin with a letter");
  return false;
}

}  // namespace navvy::scene_io
