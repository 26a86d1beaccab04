// SPDX-License-Identifier: Apache-2.0
// Reader of broken_scenes.txt, the table of faulty scenes; the head of that file gives its rules.
#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace navvy::test {

/// One scene that the loader must refuse, or a part that such scenes include.
struct BrokenScene {
  std::string file;                    ///< name with its ending
  std::string text;                    ///< content of the file
  std::vector<std::string> fragments;  ///< each must occur in the messages; empty for a part
};

/// Builds the scenes from the lines of a table.
class BrokenSceneTable {
 public:
  /// Reads the table at `path`. @throws std::runtime_error naming the line that breaks a rule.
  explicit BrokenSceneTable(const std::filesystem::path& path) {
    std::ifstream in(path);
    if (!in) throw std::runtime_error("cannot read " + path.string());
    for (std::string line; std::getline(in, line);) {
      ++number_;
      if (line.empty() || line.front() == '#') {
        finish();
      } else if (std::string("+~!").find(line.front()) == std::string::npos) {
        begin(line);
      } else {
        add(line.front(), line.size() > 2 ? line.substr(2) : "");
      }
    }
    finish();
  }

  const std::vector<BrokenScene>& scenes() const { return scenes_; }

  /// Writes all scenes and parts into `folder`, which it creates.
  void write(const std::filesystem::path& folder) const {
    std::filesystem::create_directories(folder);
    for (const BrokenScene& scene : scenes_)
      std::ofstream(folder / scene.file, std::ios::binary) << scene.text;
  }

 private:
  [[noreturn]] void fail(const std::string& rule) const {
    throw std::runtime_error("broken_scenes.txt:" + std::to_string(number_) + ": " + rule);
  }

  /// Begins the entry that `line`, "[base ]NAME:[ BASE]", declares.
  void begin(const std::string& line) {
    finish();
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos) fail("an entry begins with NAME: BASE");
    is_base_ = line.compare(0, 5, "base ") == 0;
    name_ = line.substr(is_base_ ? 5 : 0, colon - (is_base_ ? 5 : 0));
    const std::string base = colon + 2 < line.size() ? line.substr(colon + 2) : "";
    if (!base.empty() && bases_.count(base) == 0) fail("no base '" + base + "' above");
    text_ = base.empty() ? "...\n" : bases_[base];
  }

  void add(char kind, const std::string& rest) {
    if (name_.empty()) fail("a line of an entry without its NAME: BASE");
    if (kind == '+') {
      if (!edits_.empty() || !fragments_.empty()) fail("`+` lines come first in an entry");
      added_ += (has_added_ ? "\n" : "") + rest;
      has_added_ = true;
    } else if (kind == '!') {
      fragments_.push_back(rest);
    } else {
      const std::size_t arrow = rest.find(" =>");
      if (arrow == std::string::npos) fail("an edit is ~ OLD => NEW");
      const std::string old_text = rest.substr(0, arrow);
      edits_[old_text] = arrow + 4 < rest.size() ? rest.substr(arrow + 4) : "";
    }
  }

  /// Replaces the slot of the text by the added lines, and makes the edits.
  void fill() {
    const std::string slot = "...";
    const std::size_t at = text_.find(slot);
    if (has_added_ && at == std::string::npos) fail("the base of '" + name_ + "' has no `...`");
    if (has_added_) {
      text_.replace(at, slot.size(), added_);
    } else if (at != std::string::npos && !is_base_) {
      const bool alone = (at == 0 || text_[at - 1] == '\n') && text_[at + slot.size()] == '\n';
      text_.erase(at, slot.size() + (alone ? 1 : 0));
    }
    for (const auto& [old_text, new_text] : edits_) {
      const std::size_t place = text_.find(old_text);
      if (place == std::string::npos || text_.find(old_text, place + 1) != std::string::npos)
        fail("'" + old_text + "' must occur once in the text of '" + name_ + "'");
      text_.replace(place, old_text.size(), new_text);
    }
  }

  void finish() {
    if (name_.empty()) return;
    fill();
    const bool is_part = name_.find('.') != std::string::npos;
    if (is_base_) {
      bases_[name_] = text_;
    } else {
      if (fragments_.empty() != is_part)
        fail("'" + name_ + "': a scene needs fragments, a part has none");
      scenes_.push_back({is_part ? name_ : name_ + ".sdf", text_, fragments_});
    }
    name_.clear(), added_.clear(), has_added_ = false, edits_.clear(), fragments_.clear();
  }

  std::vector<BrokenScene> scenes_;
  std::map<std::string, std::string> bases_;
  int number_ = 0;
  // State of the entry being read.
  bool is_base_ = false, has_added_ = false;
  std::string name_, text_, added_;
  std::map<std::string, std::string> edits_;
  std::vector<std::string> fragments_;
};

}  // namespace navvy::test
