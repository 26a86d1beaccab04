// SPDX-License-Identifier: Apache-2.0
#include "geometry/obj/line_check.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.h"
#include "core/limits.h"

namespace navvy::geometry {
namespace {

/// Removes the next word from a line and returns it; empty at the end.
std::string_view next_word(std::string_view& line) {
  constexpr std::string_view kBlank = " \t";
  line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlank));
  line.remove_prefix(word.size());
  return word;
}

class LineCheck {
 public:
  LineCheck(const std::string& path, std::string_view text) : path_(path) {
    // Faces may refer to later vertices, so vertices are counted first.
    each_line(text, [this](std::string_view line) { vertices_ += next_word(line) == "v"; });
    most(vertices_, limits::kObjVertices, "vertices");
    each_line(text, [this](std::string_view line) {
      ++line_;
      // Faces are read corner by corner, and cutting a polygon compares all of its corners.
      if (line.size() > limits::kObjLineBytes)
        refuse_obj(path_, line_, line.substr(0, 40),
                   "a line may have at most " + std::to_string(limits::kObjLineBytes) + " bytes");
      std::string_view rest = line;
      const std::string_view key = next_word(rest);
      if (key == "v") vertex(line, rest);
      if (key == "f") face(line, rest);
      if (key == "mtllib") most(++libraries_, limits::kMtlFiles, "mtllib lines");
      if (!key.empty() && key.front() != '#' && key != "v" && key != "vt" && key != "vn" &&
          key != "f")
        most(++statements_, limits::kObjStatements, "lines of groups, objects and materials");
    });
  }

 private:
  template <class Work>
  static void each_line(std::string_view text, const Work& work) {
    while (!text.empty()) {
      const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
      work(text.substr(0, end));
      // Lines end in LF, CR LF or CR, as the library takes them.
      const std::size_t mark = text.substr(end, 2) == "\r\n" ? 2 : 1;
      text.remove_prefix(std::min(end + mark, text.size()));
    }
  }

  /// Refuses the file if `count` exceeds its limit.
  void most(long count, std::size_t limit, const char* what) const {
    if (count > static_cast<long>(limit))
      refuse_obj(path_, line_, std::to_string(count),
                 "an OBJ file may have at most " + std::to_string(limit) + " " + what,
                 "simplify or split the mesh");
  }

  /// Checks the coordinates of a vertex.
  void vertex(std::string_view line, std::string_view rest) {
    ++seen_;
    for (int k = 0; k < 3; ++k) {
      std::string_view word = next_word(rest);
      // The library accepts a plus sign, from_chars does not.
      if (!word.empty() && word.front() == '+') word.remove_prefix(1);
      double value = 0;
      const auto [end, failed] = std::from_chars(word.data(), word.data() + word.size(), value);
      // Vertices are stored in single precision, which resolves centimetres at the limit. The
      // comparison excludes nan and inf too.
      if (failed != std::errc() || end != word.data() + word.size() ||
          !(std::abs(value) <= limits::kCoordinate))
        refuse_obj(path_, line_, line, "a vertex must be three numbers from -1e6 to 1e6 m");
    }
  }

  /// Checks the corners of a face.
  void face(std::string_view line, std::string_view rest) {
    int corners = 0;
    for (std::string_view word = next_word(rest); !word.empty();
         word = next_word(rest), ++corners) {
      // vertex/texture/normal: the vertex counts from 1, or backwards from the last one read.
      long index = 0;
      const auto [end, failed] = std::from_chars(word.data(), word.data() + word.size(), index);
      const bool whole = failed == std::errc() && (end == word.data() + word.size() || *end == '/');
      if (!whole || index == 0 || index > vertices_ || index < -seen_)
        refuse_obj(path_, line_, line,
                   "a face must name vertices from 1 to " + std::to_string(vertices_));
    }
    if (corners < 3) refuse_obj(path_, line_, line, "a face must have at least three corners");
    if (corners > static_cast<int>(limits::kObjCorners))
      refuse_obj(path_, line_, std::to_string(corners),
                 "a face may have at most " + std::to_string(limits::kObjCorners) + " corners",
                 "cut it into triangles");
    most(triangles_ += corners - 2, limits::kObjTriangles, "triangles");
  }

  const std::string& path_;
  // Vertices in the whole file, and up to this line.
  long vertices_ = 0, seen_ = 0;
  long triangles_ = 0, libraries_ = 0, statements_ = 0;
  int line_ = 0;
};

}  // namespace

void check_obj_lines(const std::string& path, std::string_view text) {
  const LineCheck check(path, text);
}

void refuse_obj(const std::string& path, int line, std::string_view value, const std::string& rule,
                const std::string& remedy) {
  throw InputError(
      Fault{Fault::Severity::kError, path, line, "", std::string(value), rule, remedy});
}

}  // namespace navvy::geometry
