#include "machine/description/mesh.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <string>
#include <tuple>
#include <utility>

#include "files/input_file.h"
#include "machine/description/mesh_faces.h"
#include "machine/description/robot_description.h"

namespace robot_control {
namespace {

constexpr const char* kExport = "Export the mesh again as STL, OBJ or DAE";

std::string lower_ending(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return c < 0x80 ? static_cast<char>(std::tolower(c)) : static_cast<char>(c); });
  return ending;
}

std::string read_bytes(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    refuse(path, "mesh", "file not found", "Correct the <mesh filename>, or add the file");
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && size == 0) {
    refuse(path, "mesh", "the file is empty (0 bytes)", "Replace it with the real file, or with a <box>");
  }
  if (!error && size > kMaxMeshSize) {
    refuse(path, "mesh",
           std::to_string(size >> 20U) + " MiB exceed the limit of " + std::to_string(kMaxMeshSize >> 20U),
           "Reduce the number of faces");
  }
  InputFile file = read_input_file(path, kMaxMeshSize);
  if (!file.problem.empty()) refuse(path, "mesh", file.problem, "Check the file's permissions");
  return std::move(file.text);
}

Points faces_of(const std::filesystem::path& path) {
  const std::string ending = lower_ending(path);
  if (ending != ".stl" && ending != ".obj" && ending != ".dae") {
    refuse(path, "mesh", "unsupported mesh format \"" + ending + "\"", kExport);
  }
  const std::string bytes = read_bytes(path);
  if (is_lfs_pointer(bytes)) refuse(path, "mesh", kLfsPointer, kLfsRemedy);
  MeshFaces faces = ending == ".stl" ? parse_stl(bytes) : parse_with_assimp(bytes, ending.substr(1));
  if (!faces.problem.empty()) refuse(path, "mesh", "unreadable: " + faces.problem, kExport);
  return std::move(faces.points);
}

bool before(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::tie(a.x(), a.y(), a.z()) < std::tie(b.x(), b.y(), b.z());
}

}  // namespace

Points read_mesh(const std::filesystem::path& path, std::size_t* not_finite) {
  Points points = faces_of(path);
  const std::size_t erased = std::erase_if(points, [](const Eigen::Vector3d& point) { return !point.allFinite(); });
  if (not_finite != nullptr) *not_finite = erased;
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) {
    refuse(path, "mesh", "it is empty: it has no face with an area", "Replace it with a <box> or <cylinder>");
  }
  return points;
}

MeshCorners mesh_corners(const std::filesystem::path& path) {
  using Version = std::tuple<std::uintmax_t, std::filesystem::file_time_type>;
  static std::mutex mutex;
  static std::map<std::filesystem::path, std::pair<Version, MeshCorners>> remembered;

  std::error_code no_size, no_time;
  const Version version{std::filesystem::file_size(path, no_size), std::filesystem::last_write_time(path, no_time)};
  const std::lock_guard lock(mutex);
  const auto found = remembered.find(path);
  if (!no_size && !no_time && found != remembered.end() && found->second.first == version) return found->second.second;
  MeshCorners corners;
  corners.points = hull_corners(read_mesh(path, &corners.not_finite));
  remembered[path] = {version, corners};
  return corners;
}

}  // namespace robot_control
