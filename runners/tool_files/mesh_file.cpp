#include "runners/tool_files/mesh_file.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/version.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <map>
#include <stdexcept>

#include "analysis/storage/packed_values.h"
#include "core/parameters/input_error.h"
#include "core/tool/mesh/mesh_corners.h"
#include "runners/tool_files/ply_header.h"

namespace remote_touch {

namespace {

constexpr std::size_t kMaxTriangles = 5'000'000;
constexpr std::size_t kMemoryPerByte = 64;  // of a file: more than the costliest kind needs

std::string ending_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return ending;
}

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
    for (unsigned corner = 0; corner < face.mNumIndices; ++corner)
      if (face.mIndices[corner] >= index.size())
        throw std::runtime_error("a face has a vertex that is not there");
    for (unsigned corner = 2; corner < face.mNumIndices; ++corner)
      mesh.triangles.push_back(
          {index[face.mIndices[0]], index[face.mIndices[corner - 1]], index[face.mIndices[corner]]});
  }
}

}  // namespace

bool is_mesh_file(const std::filesystem::path& file) {
  const std::string ending = ending_of(file);
  return ending == ".obj" || ending == ".ply" || ending == ".stl";
}

namespace {

// As the library reads it. In a child, for the library believes what a file says: damaged ones make it take
// all memory or go on for ever.
TriangleMesh mesh_by_assimp(const std::string& file) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(file, 0);
  if (scene == nullptr) {
    const std::string error = importer.GetErrorString();
    throw std::runtime_error(error == "std::bad_alloc" ? "it claims more than fits into memory" : error);
  }
  TriangleMesh mesh;
  Welded welded(mesh);
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    add_mesh(*scene->mMeshes[m], welded, mesh);
    if (mesh.triangles.size() > kMaxTriangles)
      throw std::runtime_error("it has more than 5 million triangles");
  }
  return mesh;
}

// In the child.
std::string packed_mesh(const std::string& file) {
  const TriangleMesh mesh = mesh_by_assimp(file);
  MemoryPacker pack;
  pack.list(mesh.vertices), pack.list(mesh.triangles);
  return pack.take();
}

TriangleMesh mesh_in_child(const std::filesystem::path& file, const RunInChild& run) {
  const std::string bytes = run(limits_to_read(file, kMemoryPerByte), packed_mesh, file.string());
  TriangleMesh mesh;
  Unpacker unpack(bytes);
  unpack.list(mesh.vertices), unpack.list(mesh.triangles);
  if (!unpack.done() || !has_its_vertices(mesh)) throw std::runtime_error("its reader gave half an answer");
  return mesh;
}

}  // namespace

TriangleMesh read_mesh(const std::filesystem::path& file, const RunInChild& run) {
  const char* allowed = "expected an OBJ, PLY or STL file";
  if (!is_mesh_file(file)) throw InputError(file.string(), std::string("not a mesh: ") + allowed);
  if (!std::filesystem::is_regular_file(file))
    throw InputError(file.string(), std::string("no such file: ") + allowed);
  TriangleMesh mesh;
  try {
    if (ending_of(file) == ".ply")
      if (const std::string problem = ply_problem(file); !problem.empty()) throw std::runtime_error(problem);
    mesh = mesh_in_child(file, run);
  } catch (const std::runtime_error& error) {
    throw InputError(file.string(), "cannot be read (" + one_line(error.what()) + "); " + allowed);
  }
  if (mesh.triangles.empty()) throw InputError(file.string(), std::string("holds no faces; ") + allowed);
  return mesh;
}

std::string mesh_reader_version() {
  return "assimp " + std::to_string(aiGetVersionMajor()) + "." + std::to_string(aiGetVersionMinor()) + "." +
         std::to_string(aiGetVersionPatch());
}

}  // namespace remote_touch
