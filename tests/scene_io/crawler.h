// SPDX-License-Identifier: Apache-2.0
// A crawler excavator in URDF as its author may have exported it: placeholders for masses and
// torques, axes that lower the arm, a turned frame of the bucket, and no word on what is what.
#pragma once

#include <fstream>
#include <string>

#include "geometry/bucket_shape.h"

namespace navvy::scene_io::testing {

/// Masses that make it an excavator of 18 t.
inline const std::string kCrawlerMasses =
    "link,mass_kg\n# by the data "
    "sheet\nbase_link,8100\nhouse,7000\narm_1,1350\narm_2,850\nscoop,700\n";

inline std::string crawler_link(const std::string& name, const std::string& shapes) {
  std::string out = "<link name='" + name +
                    "'><inertial><mass value='0.03'/><inertia ixx='1e-4' ixy='0' ixz='0' iyy='1e-4'"
                    " iyz='0' izz='1e-4'/></inertial>";
  for (const char* kind : {"visual", "collision"}) {
    std::string shape = shapes;
    for (std::size_t at = shape.find("SHAPE"); at != std::string::npos; at = shape.find("SHAPE"))
      shape.replace(at, 5, kind);
    out += shape;
  }
  return out + "</link>\n";
}

inline std::string box_at(const std::string& xyz, const std::string& size) {
  return "<SHAPE><origin xyz='" + xyz + "'/><geometry><box size='" + size +
         "'/></geometry></SHAPE>";
}

inline std::string crawler_joint(const std::string& name, const std::string& type,
                                 const std::string& parent, const std::string& child,
                                 const std::string& origin, const std::string& axis,
                                 const std::string& range) {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><origin " + origin + "/><axis xyz='" + axis +
         "'/><limit " + range + " effort='1000' velocity='0.5'/></joint>\n";
}

/// Writes `folder`/crawler.urdf and its mesh. The bucket is 1.05 m wide, its edge 1.4 m from its
/// pin.
template <class Folder>
void write_crawler(const Folder& folder) {
  // The frame of the bucket's link is turned by 90 deg about x: its y axis points up.
  std::ofstream mesh(folder / "scoop.obj");
  const geometry::TriangleMesh bucket =
      geometry::bucket_picture({1.05, 1.4, 0.03, 0.035}, 1, {}, {});
  for (const Vec3& v : bucket.vertices)
    mesh << "v " << v.x() << " " << v.z() << " " << -v.y() << "\n";
  for (const auto& t : bucket.triangles)
    mesh << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
  std::ofstream(folder / "crawler.urdf")
      << "<robot name='crawler'>\n"
      << crawler_link("base_link", box_at("0 1.1 0.4", "3.6 0.6 0.8") +
                                       box_at("0 -1.1 0.4", "3.6 0.6 0.8") +
                                       box_at("0 0 0.7", "1.8 1.6 0.5"))
      << crawler_link("house", box_at("-0.6 0 0.8", "2.9 2.4 1.3"))
      << crawler_link("arm_1", box_at("2.5 0 0.35", "4.8 0.4 0.5"))
      << crawler_link("arm_2", box_at("0.95 0 0.05", "2.6 0.34 0.4"))
      << crawler_link("scoop", "<SHAPE><geometry><mesh filename='scoop.obj'/></geometry></SHAPE>")
      << crawler_joint("turn", "continuous", "base_link", "house", "xyz='0 0 1.1'", "0 0 1", "")
      << crawler_joint("j1", "revolute", "house", "arm_1", "xyz='0.25 0 0.8'", "0 1 0",
                       "lower='-1.05' upper='0.85'")
      << crawler_joint("j2", "revolute", "arm_1", "arm_2", "xyz='5.1 0 0'", "0 1 0",
                       "lower='0.6' upper='2.75'")
      << crawler_joint("j3", "revolute", "arm_2", "scoop",
                       "xyz='2.45 0 0' rpy='1.5707963267948966 0 0'", "0 0 -1",
                       "lower='-0.4' upper='2.6'")
      << "</robot>";
}

}  // namespace navvy::scene_io::testing
