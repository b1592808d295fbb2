#include "runners/experiment/mesh_files/mesh_file.h"

#include <assimp/scene.h>
#include <assimp/version.h>

#include <algorithm>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "analysis/storage/digest.h"
#include "analysis/storage/other_processes.h"
#include "core/mesh/triangle_mesh.h"
#include "core/parameters/parameter.h"
#include "core/points/vector.h"

namespace remote_touch {
namespace {

constexpr std::size_t kMaxTriangles = 5'000'000;
constexpr std::size_t kMemoryPerByte = 64;  // memory per byte of a file: the costliest kind needs less

std::string ending_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}

std::string one_line(std::string text) {
  for (char& c : text)
    if (std::iscntrl(static_cast<unsigned char>(c))) c = ' ';
  return text;
}

// Adds vertices to a mesh. Several vertices at the same position are added once.
class Welded {
 public:
  explicit Welded(TriangleMesh& mesh) : mesh_(mesh) {}
  int add(const aiVector3D& v) {
    // 0 and -0 are one position. A map cannot hold NaN.
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

[[noreturn]] void refuse_polygon(const Vec3& first, std::size_t corners) {
  std::ostringstream problem;
  problem << "a face of " << corners << " corners, the first at " << first.x() << " " << first.y() << " "
          << first.z() << ", crosses or touches itself: no triangles have its area";
  throw std::runtime_error(problem.str());
}

// Cuts a polygon into triangles and adds them. A corner that is given twice in a row counts once. A polygon
// with fewer than three corners is left out.
void add_polygon(std::vector<int> polygon, TriangleMesh& mesh) {
  polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
  while (polygon.size() > 1 && polygon.front() == polygon.back()) polygon.pop_back();
  if (polygon.size() < 3) return;
  std::vector<Vec3> corners;
  for (const int v : polygon) corners.push_back(mesh.vertices[v]);
  if (!std::ranges::all_of(corners, [](const Vec3& v) { return v.allFinite(); }))
    throw std::runtime_error("a face has a vertex that is not finite");
  const auto triangles = polygon_triangles(corners);
  if (!triangles) refuse_polygon(corners.front(), corners.size());
  for (const auto& [a, b, c] : *triangles) mesh.triangles.push_back({polygon[a], polygon[b], polygon[c]});
}

void add_mesh(const aiMesh& from, Welded& welded, TriangleMesh& mesh) {
  std::vector<int> index;
  for (unsigned v = 0; v < from.mNumVertices; ++v) index.push_back(welded.add(from.mVertices[v]));
  for (unsigned f = 0; f < from.mNumFaces; ++f) {
    const aiFace& face = from.mFaces[f];
    std::vector<int> polygon;
    for (unsigned corner = 0; corner < face.mNumIndices; ++corner) {
      if (face.mIndices[corner] >= index.size())
        throw std::runtime_error("a face refers to a vertex that does not exist");
      polygon.push_back(index[face.mIndices[corner]]);
    }
    if (polygon.size() == 3)
      mesh.triangles.push_back({polygon[0], polygon[1], polygon[2]});
    else if (polygon.size() > 3)
      add_polygon(std::move(polygon), mesh);
  }
}

// Listens to the log of the library while it exists. found() is true if the library has logged that it left
// out a part of a facet of an STL file, or took two facets for one. The library reports this nowhere else.
class FacetWatch final : public Assimp::LogStream {
 public:
  FacetWatch() {
    Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
    Assimp::DefaultLogger::get()->attachStream(this, kSeverity);
  }
  ~FacetWatch() override {
    Assimp::DefaultLogger::get()->detachStream(this, kSeverity);
    Assimp::DefaultLogger::kill();
  }
  FacetWatch(const FacetWatch&) = delete;
  FacetWatch& operator=(const FacetWatch&) = delete;

  void write(const char* message) override {
    if (std::string_view(message).find("facet") != std::string_view::npos) found_ = true;
  }
  bool found() const { return found_; }

 private:
  static constexpr unsigned kSeverity = Assimp::Logger::Warn | Assimp::Logger::Err;
  bool found_ = false;
};

// Throws std::runtime_error unless a binary STL file has as many bytes as its count of facets needs. The
// library refuses other sizes too, but not in plain words.
void require_whole_facets(const std::string& stl) {
  constexpr std::size_t kCountAt = 80, kHeader = 84, kFacet = 50;
  if (stl.size() < kHeader)
    throw std::runtime_error(
        "it is no text that begins with the word solid, and lacks the 84 bytes of a binary header");
  std::uint32_t facets = 0;
  std::memcpy(&facets, stl.data() + kCountAt, sizeof facets);
  const std::size_t needed = kHeader + kFacet * std::size_t{facets};
  if (stl.size() != needed)
    throw std::runtime_error("its header claims " + std::to_string(facets) + " facets, which need " +
                             std::to_string(needed) + " bytes: it has " + std::to_string(stl.size()));
}

// Returns the scene, which the importer owns; null if the library cannot read the file. The library receives
// the bytes without a byte order mark and without the parts that it reads wrongly. A text that it could
// misread is refused before, by std::runtime_error.
const aiScene* scene_of(const std::string& file, Assimp::Importer& importer) {
  const std::string ending = ending_of(file);
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  std::string bytes = opening_of(file, std::filesystem::file_size(file));
  if (bytes.starts_with(kMark)) bytes.erase(0, kMark.size());
  if (ending == ".obj") bytes = only_shape(bytes);
  if (ending == ".ply") bytes = with_vertices_first(bytes);
  if (ending == ".stl" && is_stl_text(bytes))
    bytes = plain_stl(bytes);
  else if (ending == ".stl")
    require_whole_facets(bytes);
  // The library has no message of its own for this.
  if (bytes.find_first_not_of(" \t\r\n") == std::string::npos)
    throw std::runtime_error("it has neither vertices nor faces");
  return importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, ending.c_str() + 1);
}

// Reads the mesh with the library. Must run in a child process, because the library trusts the file: a
// damaged one can make it allocate all memory or never end.
TriangleMesh mesh_by_assimp(const std::string& file) {
  const FacetWatch facets;
  Assimp::Importer importer;
  const aiScene* scene = scene_of(file, importer);
  if (scene != nullptr && ending_of(file) == ".stl" && facets.found())
    throw std::runtime_error("a facet does not have three vertices");
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

// Reads and packs the mesh, in the child process.
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
  if (!unpack.done() || !has_its_vertices(mesh))
    throw std::runtime_error("its reader sent an incomplete answer");
  return mesh;
}

// Throws std::runtime_error if single precision, in which the library reads, changes the shape: half of its
// last digit must be at most 1e-4 of the size.
void require_precise(const TriangleMesh& mesh) {
  BoundingBox box;
  for (const auto& triangle : mesh.triangles)
    for (const int corner : triangle)
      if (mesh.vertices[static_cast<std::size_t>(corner)].allFinite())
        box.extend(mesh.vertices[static_cast<std::size_t>(corner)]);
  if (box.isEmpty()) return;
  const double farthest = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  const double size = box.sizes().maxCoeff(), rounding = 0x1p-24 * farthest;
  if (rounding <= 1e-4 * size) return;
  std::ostringstream problem;
  problem << "its coordinates reach " << farthest << " and are read in single precision, to " << rounding
          << ", but its longest side is " << size << ": expected a mesh nearer to its origin";
  throw std::runtime_error(problem.str());
}

}  // namespace

bool is_mesh_file(const std::filesystem::path& file) {
  const std::string ending = ending_of(file);
  return ending == ".obj" || ending == ".ply" || ending == ".stl";
}

TriangleMesh read_mesh(const std::filesystem::path& file, const RunInChild& run) {
  const char* allowed = "expected an OBJ, PLY or STL file";
  if (!is_mesh_file(file)) throw InputError(file.string(), std::string("not a mesh: ") + allowed);
  if (!std::filesystem::is_regular_file(file))
    throw InputError(file.string(), std::string("no such file: ") + allowed);
  TriangleMesh mesh;
  try {
    if (std::filesystem::file_size(file) == 0) throw std::runtime_error("it is empty");
    if (ending_of(file) == ".ply")
      if (const std::string problem = ply_problem(file); !problem.empty()) throw std::runtime_error(problem);
    mesh = mesh_in_child(file, run);
    require_precise(mesh);
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

std::string names_of_built_in_meshes() {
  std::string names;
  for (const GeneratedTool& tool : generated_tools())
    names += std::string(names.empty() ? "" : ", ") + tool.name;
  return names;
}

std::string mesh_name_problem(const std::string& parameter, const std::string& name) {
  if (find_generated_tool(name) != nullptr || is_mesh_file(name)) return {};
  return parameter + " = " + (name.empty() ? "\"\"" : name) + ": expected " + names_of_built_in_meshes() +
         ", or an OBJ, PLY or STL file";
}

std::vector<InputPart> mesh_files_of(const std::string& name) {
  if (name.empty() || find_generated_tool(name) != nullptr) return {};
  return {{name}};
}

std::string find_mesh_file(const std::string& parameter, const std::string& name) {
  try {
    return find_input(name);
  } catch (const MissingInput&) {
    throw MissingInput(parameter + " = " + name, "no such mesh: expected " + names_of_built_in_meshes() +
                                                     ", or an OBJ, PLY or STL file " + input_places());
  }
}

TriangleMesh mesh_named(const std::string& parameter, const std::string& name) {
  if (const GeneratedTool* built_in = find_generated_tool(name)) return built_in->make();
  return read_mesh(find_mesh_file(parameter, name));
}

}  // namespace remote_touch
