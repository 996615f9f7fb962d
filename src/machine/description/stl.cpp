#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <limits>

#include "machine/description/mesh_faces.h"

namespace robot_control {
namespace {

constexpr std::size_t kHeader = 80;
constexpr std::size_t kPreamble = kHeader + sizeof(std::uint32_t);
constexpr std::size_t kNormal = 3 * sizeof(float);
constexpr std::size_t kFace = 50;

std::size_t binary_faces(std::string_view bytes) {
  std::uint32_t count = 0;
  if (bytes.size() >= kPreamble) std::memcpy(&count, bytes.data() + kHeader, sizeof count);
  return count;
}

std::vector<Eigen::Vector3d> parse_binary(std::string_view bytes) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(3 * binary_faces(bytes));
  for (std::size_t face = kPreamble; face < bytes.size(); face += kFace) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      float xyz[3];
      std::memcpy(xyz, bytes.data() + face + kNormal + corner * sizeof xyz, sizeof xyz);
      points.emplace_back(xyz[0], xyz[1], xyz[2]);
    }
  }
  return points;
}

class Words {
 public:
  explicit Words(std::string_view text) : rest_(text) {}

  /// Returns the next word; empty at the end.
  std::string_view next() {
    constexpr std::string_view kSpace = " \t\r\n\v\f";
    rest_.remove_prefix(std::min(rest_.find_first_not_of(kSpace), rest_.size()));
    const std::string_view word = rest_.substr(0, rest_.find_first_of(kSpace));
    rest_.remove_prefix(word.size());
    return word;
  }

  bool number(double& value) {
    std::string_view word = next();
    if (word.starts_with('+')) word.remove_prefix(1);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    // If a double cannot hold the number, from_chars leaves `value` unchanged.
    if (error == std::errc::result_out_of_range) value = is_tiny(word) ? 0 : std::numeric_limits<double>::infinity();
    return !word.empty() && end == word.data() + word.size() && error != std::errc::invalid_argument;
  }

 private:
  static bool is_tiny(std::string_view word) {
    const std::size_t exponent = word.find_first_of("eE");
    return exponent != std::string_view::npos && word.substr(exponent + 1).starts_with('-');
  }

  std::string_view rest_;
};

bool is(std::string_view word, std::string_view keyword) {
  return word.size() == keyword.size() &&
         std::equal(word.begin(), word.end(), keyword.begin(), [](char a, char b) { return (a | 0x20) == b; });
}

MeshFaces parse_text(std::string_view text) {
  MeshFaces faces;
  Words words(text);
  bool ended = false;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (is(word, "vertex")) {
      Eigen::Vector3d point;
      if (!words.number(point[0]) || !words.number(point[1]) || !words.number(point[2])) {
        faces.problem = "a vertex does not have three numbers";
        return faces;
      }
      faces.points.push_back(point);
    } else if (is(word, "endfacet") && faces.points.size() % 3 != 0) {
      faces.problem = "a facet does not have three vertices";
      return faces;
    } else if (is(word, "endsolid")) {
      ended = true;
    }
  }
  if (!ended)
    faces.problem = "the file is incomplete: neither a binary STL of 84 + 50 n bytes, nor a text with endsolid";
  return faces;
}

}  // namespace

MeshFaces parse_stl(std::string_view bytes) {
  if (bytes.size() >= kPreamble && bytes.size() == kPreamble + kFace * binary_faces(bytes)) {
    return {parse_binary(bytes), {}};
  }
  return parse_text(bytes);
}

}  // namespace robot_control
