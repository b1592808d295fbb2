#include "runners/tool_files/mesh_file.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/version.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <map>

#include "core/parameters/input_error.h"

namespace remote_touch {

namespace {

constexpr std::size_t kMostTriangles = 5'000'000;

std::string one_line(std::string text) {
  for (char& c : text)
    if (std::iscntrl(static_cast<unsigned char>(c))) c = ' ';
  return text;
}

// Vertices by their positions, each once.
class Welded {
 public:
  explicit Welded(TriangleMesh& mesh) : mesh_(mesh) {}
  int add(const aiVector3D& v) {
    // 0 and -0 are one place, and a map cannot hold what is no number.
    const std::array<float, 3> at{v.x + 0.0f, v.y + 0.0f, v.z + 0.0f};
    if (!Vec3(at[0], at[1], at[2]).allFinite()) {
      mesh_.vertices.emplace_back(at[0], at[1], at[2]);
      return static_cast<int>(mesh_.vertices.size()) - 1;
    }
    const auto [found, is_new] = index_.try_emplace(at, static_cast<int>(mesh_.vertices.size()));
    if (is_new) mesh_.vertices.emplace_back(at[0], at[1], at[2]);
    return found->second;
  }

 private:
  TriangleMesh& mesh_;
  std::map<std::array<float, 3>, int> index_;
};

void add_mesh(const aiMesh& from, Welded& welded, TriangleMesh& mesh) {
  std::vector<int> index;
  for (unsigned v = 0; v < from.mNumVertices; ++v) index.push_back(welded.add(from.mVertices[v]));
  for (unsigned f = 0; f < from.mNumFaces; ++f) {
    const aiFace& face = from.mFaces[f];
    for (unsigned corner = 2; corner < face.mNumIndices; ++corner)
      mesh.triangles.push_back(
          {index[face.mIndices[0]], index[face.mIndices[corner - 1]], index[face.mIndices[corner]]});
  }
}

}  // namespace

bool is_mesh_file(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return ending == ".obj" || ending == ".ply" || ending == ".stl";
}

TriangleMesh read_mesh(const std::filesystem::path& file) {
  const char* allowed = "allowed an OBJ, PLY or STL file";
  if (!is_mesh_file(file)) throw InputError(file.string(), std::string("not a mesh; ") + allowed);
  if (!std::filesystem::is_regular_file(file))
    throw InputError(file.string(), std::string("no such file; ") + allowed);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(file.string(), 0);
  if (scene == nullptr)
    throw InputError(file.string(),
                     "cannot be read (" + one_line(importer.GetErrorString()) + "); " + allowed);
  TriangleMesh mesh;
  Welded welded(mesh);
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    add_mesh(*scene->mMeshes[m], welded, mesh);
    if (mesh.triangles.size() > kMostTriangles)
      throw InputError(file.string(), "has more than 5 million triangles; allowed fewer");
  }
  if (mesh.triangles.empty()) throw InputError(file.string(), std::string("holds no faces; ") + allowed);
  return mesh;
}

std::string mesh_reader_version() {
  return "assimp " + std::to_string(aiGetVersionMajor()) + "." + std::to_string(aiGetVersionMinor()) + "." +
         std::to_string(aiGetVersionPatch());
}

}  // namespace remote_touch
