#include "robot/assimp_mesh.h"

#include <assimp/BaseImporter.h>
#include <assimp/config.h>
#include <assimp/scene.h>

#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <memory>

#include "robot/collada_nodes.h"

namespace robot_control {
namespace {

/// Materials and textures beside a mesh are not there.
class NoFiles final : public Assimp::IOSystem {
 public:
  bool Exists(const char*) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
  void Close(Assimp::IOStream*) override {}
};

// A reader that is not registered cannot take a broken file for one of its own.
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

}  // namespace

MeshFaces parse_with_assimp(std::string_view bytes, const std::string& format) {
  if (format == "dae") {
    if (std::string problem = collada_node_problem(bytes); !problem.empty()) return {{}, std::move(problem)};
  }
  Assimp::Importer importer;
  importer.SetIOHandler(std::make_unique<NoFiles>().release());
  keep_only(importer, format);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, format.c_str());
  if (scene == nullptr || scene->mRootNode == nullptr) return {{}, importer.GetErrorString()};
  MeshFaces faces;
  collect(*scene, *scene->mRootNode, aiMatrix4x4(), faces.points);
  return faces;
}

}  // namespace robot_control
