#pragma once
/// One triangle in each format: corners (0, 0, 0), (1, 0, 0), (0, 2, 0).

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "support/robots/diffbot_urdf.h"

namespace robot_control {

template <typename T>
std::string bytes_of(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

/// 80 bytes of header, the count, and 50 per face; `header` holds the first bytes.
inline std::string binary_stl(const std::string& header, const std::vector<std::array<float, 9>>& faces) {
  std::string bytes = header;
  bytes.resize(80, ' ');
  bytes += bytes_of(static_cast<std::uint32_t>(faces.size()));
  for (const auto& face : faces) {
    bytes += std::string(12, '\0');
    for (const float coordinate : face) bytes += bytes_of(coordinate);
    bytes += std::string(2, '\0');
  }
  return bytes;
}

inline const std::string kBinaryStl = binary_stl("", {{0, 0, 0, 1, 0, 0, 0, 2, 0}});

inline const std::string kTextStl =
    "solid triangle\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1.0e0 0 0\n   vertex 0 +2 0\n"
    "  endloop\n endfacet\nendsolid triangle\n";

inline const std::string kObj = "# a triangle\nv 0 0 0\nv 1 0 0\nv 0 2 0\nvn 0 0 1\nf 1//1 2//1 3//1\n";

inline const std::string kDae =
    "<?xml version=\"1.0\"?>\n"
    "<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">\n"
    "<asset><unit meter=\"1\"/><up_axis>Z_UP</up_axis></asset>\n"
    "<library_geometries><geometry id=\"g\"><mesh>\n"
    "<source id=\"p\"><float_array id=\"a\" count=\"9\">0 0 0 1 0 0 0 2 0</float_array><technique_common>"
    "<accessor count=\"3\" source=\"#a\" stride=\"3\"><param name=\"X\" type=\"float\"/>"
    "<param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor></technique_common></source>\n"
    "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>\n"
    "<triangles count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 2</p></triangles>\n"
    "</mesh></geometry></library_geometries>\n"
    "<library_visual_scenes><visual_scene id=\"s\"><node id=\"n\"><instance_geometry url=\"#g\"/></node>"
    "</visual_scene></library_visual_scenes>\n"
    "<scene><instance_visual_scene url=\"#s\"/></scene>\n</COLLADA>\n";

inline std::string dae_with(const std::string& from, const std::string& to) {
  return replaced(kDae, "<?xml", from, to);
}

}  // namespace robot_control
