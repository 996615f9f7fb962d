#include <assimp/BaseImporter.h>
#include <assimp/config.h>
#include <assimp/scene.h>

#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <memory>

#include "machine/description/mesh_faces.h"
#include "machine/description/other_process.h"

namespace robot_control {
namespace {

/// Hides materials and textures beside a mesh.
class NoFiles final : public Assimp::IOSystem {
 public:
  bool Exists(const char*) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
  void Close(Assimp::IOStream*) override {}
};

// Only the wanted reader stays registered, because another one could accept a broken file as its own format.
void keep_only(Assimp::Importer& importer, const std::string& format) {
  Assimp::BaseImporter* const wanted = importer.GetImporter(format.c_str());
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    Assimp::BaseImporter* const loader = importer.GetImporter(i);
    if (loader == wanted) continue;
    importer.UnregisterLoader(loader);
    const std::unique_ptr<Assimp::BaseImporter> mine_now(loader);
  }
}

void collect(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent,
             std::vector<Eigen::Vector3d>& points) {
  const aiMatrix4x4 in_root = parent * node.mTransformation;
  for (unsigned int m = 0; m < node.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[m]];
    for (unsigned int f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      for (unsigned int i = 0; face.mNumIndices >= 3 && i < face.mNumIndices; ++i) {
        if (face.mIndices[i] >= mesh.mNumVertices) continue;
        const aiVector3D point = in_root * mesh.mVertices[face.mIndices[i]];
        points.emplace_back(point.x, point.y, point.z);
      }
    }
  }
  for (unsigned int i = 0; i < node.mNumChildren; ++i) collect(scene, *node.mChildren[i], in_root, points);
}

/// Returns "F" and the points' bytes, or "P" and the problem.
std::string parsed(std::string_view bytes, const std::string& format) {
  Assimp::Importer importer;
  importer.SetIOHandler(std::make_unique<NoFiles>().release());
  keep_only(importer, format);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, format.c_str());
  if (scene == nullptr || scene->mRootNode == nullptr) return std::string(1, 'P').append(importer.GetErrorString());
  std::vector<Eigen::Vector3d> points;
  collect(*scene, *scene->mRootNode, aiMatrix4x4(), points);
  return std::string(1, 'F').append(reinterpret_cast<const char*>(points.data()),
                                    points.size() * sizeof(Eigen::Vector3d));
}

}  // namespace

MeshFaces parse_with_assimp(std::string_view bytes, const std::string& format) {
  const ProcessResult result = run_apart([&] { return parsed(bytes, format); });
  if (result.end == ProcessResult::End::kNotStarted) return {{}, "the process that reads it did not start"};
  if (result.end != ProcessResult::End::kExited || result.code != 0 || result.output.empty()) {
    return {{}, "assimp crashes when it reads it"};
  }
  if (result.output[0] == 'P') return {{}, result.output.substr(1)};
  MeshFaces faces;
  faces.points.resize((result.output.size() - 1) / sizeof(Eigen::Vector3d));
  result.output.copy(reinterpret_cast<char*>(faces.points.data()), std::string::npos, 1);
  return faces;
}

}  // namespace robot_control
