// Meshes from files, OBJ, PLY and STL, meshes that a user names, and scenarios with them.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/storage/other_processes.h"
#include "core/mesh/triangle_mesh.h"
#include "core/parameters/parameter.h"
#include "scenarios/objects/mesh_object.h"
#include "scenarios/objects/mesh_scene.h"
#include "scenarios/recordings/recorded_scene.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {

// True if the file's name ends like that of a mesh file, in upper or lower case.
bool is_mesh_file(const std::filesystem::path& file);

// Returns all meshes of the file as one mesh. Vertices at equal positions are welded, and polygons are cut
// into triangles of their area (triangle_mesh.h). Lines and points are left out. Coordinates have single
// precision, in the unit of the file. Throws InputError, with the name of the file, also for a polygon that
// cannot be cut, and if single precision is coarser than 1e-4 of the mesh's size, as at map coordinates. run:
// runs the child process, because the library reads the file only there.
TriangleMesh read_mesh(const std::filesystem::path& file, const RunInChild& run = in_own_child);

// Returns the version of the library that reads the files, which is not a part of the program. Another
// version may read a file differently.
std::string mesh_reader_version();

// Meshes that a user names: built-in ones and files.

// "dog, husky, ...": the names of the meshes that need no file, see triangle_mesh.h.
std::string names_of_built_in_meshes();

// Returns why this can be no name of a mesh, in one line; empty if it can. parameter: its name.
std::string mesh_name_problem(const std::string& parameter, const std::string& name);

// Returns the file on which the mesh depends; none for a built-in mesh or an empty name.
std::vector<InputPart> mesh_files_of(const std::string& name);

// Returns the path of the mesh file, searched for as find_input() does. Throws MissingInput about the
// parameter if there is none.
std::string find_mesh_file(const std::string& parameter, const std::string& name);

// Returns the mesh in the unit of its file; a built-in mesh is in metres and takes precedence over a file of
// its name. Throws as find_mesh_file() and read_mesh().
TriangleMesh mesh_named(const std::string& parameter, const std::string& name);

// Only for use in this folder: checks, and conversions to what the library reads correctly.

// Words and numbers of mesh files that are text are checked here, because the library that reads these files
// accepts a word that only begins with a number ("0x9" as 0, "9D-1" as 9), and reads numbers that are missing
// in a line from the next line.

// Throws std::runtime_error "line N: PROBLEM" for the line of the text that contains the byte `at`;
// lines are counted from 1.
[[noreturn]] void refuse_line(std::string_view text, std::size_t at, const std::string& problem);
// Returns the word in quotes, shortened, for a message.
std::string in_quotes(std::string_view word);

// Converts an OBJ file: returns the same shape without parts that a tool does not use and the library may
// refuse: texture coordinates, normals, the files of materials, colours, comments behind the values of a
// line, and the references of faces and lines to these parts. Each line begins with its first word, because
// the library skips lines that are indented. The weight w of `v x y z w` is left out, because only rational
// curves and surfaces have it. Throws std::runtime_error, with the number of the line, for a vertex of 1, 2,
// 5 or more than 7 numbers, for a word that is not a number, and for a corner that is not a vertex.
std::string only_shape(const std::string& obj);

// True if the bytes are an STL file of text: they begin with "solid", in any case, have no byte 0, and do not
// have the length that a binary file with their number of facets has.
bool is_stl_text(const std::string& bytes);

// Returns the same triangles, written as the library expects them: keywords in lower case, no names, and
// normals of 0, because a tool does not use normals. Throws std::runtime_error, with the number of the line,
// for a facet without exactly three vertices of three numbers, and for any word that the format does not
// have, also at the end.
std::string plain_stl(const std::string& text);

// Checks of PLY files, whose data the library that reads them does not compare with the header.

// Returns the problem of the header in one line, such as counts that the file is too short for; empty if
// there is none.
std::string ply_problem(const std::filesystem::path& file);

// Returns the file with the vertices first, as the library needs them, and without empty lines. The other
// elements keep their order. pre: ply_problem() finds none. Throws std::runtime_error for a format or a type
// that is unknown, for data that end before the last element, and for anything but blanks after it. Each
// element of a text must be a line with all its values and no others, and with integers if the type is an
// integer type; the message then has the number of the line.
std::string with_vertices_first(const std::string& ply);

// Scenarios with meshes of the user: a scene of meshes, and a recording whose true surface comes from mesh
// files.

// A mesh that a user names and places in a scene: its size, its pose or path of poses, and its colour.
//
// The pose of the object in the world frame W, whose y is up, is
//   X_WO(t) = translation(position_m + d(t)) turn(t) translation(shift) rotation(rotation_deg) path(t).
// d(t) and turn(t) are the displacement and the rotation of `motion`, along the axes of the world frame and
// about position_m. path(t) is the pose in the file `path` at the time t on the clock of the scene's files.
// Without them the object rests. `shift` is 0 for the origin of the file; for the bottom it puts the middle
// of the bottom of the object's bounding box at t = 0 at position_m.
struct PlacedMesh {
  enum class Origin { bottom, file };
  std::string mesh;  // name of mesh_named(); empty: no object
  double size_m = 0;
  Origin origin = Origin::bottom;
  Vec3 position_m = Vec3::Zero();
  Vec3 rotation_deg = Vec3::Zero();  // rotation vector
  std::vector<double> motion = {};   // rows of time_s, x_m, y_m, z_m, rx_deg, ry_deg, rz_deg; or
  std::string path = {};             // file of stamped poses, object to its parent frame
  std::string colour = {};           // "#rrggbb"; empty: none
  bool sheet = false;                // an open surface, seen from the side of its normals
  bool repair = false;
};

// prefix: begins the names of all parameters, such as "second_".
Parameters parameters(PlacedMesh& s, const std::string& prefix);
std::string validate(const PlacedMesh& s, const std::string& prefix);
std::vector<InputPart> input_files(const PlacedMesh& s);

// Reads the mesh. path: the content of the file `path`; a pose at rest without a file. A mesh that is not
// closed or not outwards everywhere is repaired if `repair` is set. Throws MissingInput if the file is
// not there, and InputError as read_mesh() and checked_object() do, and if a part of the mesh is inside out
// and is no hollow of another part. Pre: mesh is not empty, validate() finds no problem.
SceneMesh load(const PlacedMesh& s, const std::string& prefix, const PosePath& path);

// A scene of meshes as a scenario of the program: a mesh of the user under the hand.
class MeshSceneFromFiles final : public MeshScene {
 public:
  struct Settings {
    MeshScene::Settings scene{
        .sensor = {.camera = {.camera_position_m = {0, 0.5, 0.35}, .target_position_m = {0, 0.03, 0}},
                   .max_depth_m = 10}};
    // The objects; their parameters begin with "", "second_" and "third_".
    std::array<PlacedMesh, 3> objects = {PlacedMesh{.mesh = "husky", .size_m = 0.2}};
    // A square sheet that faces up, around the middle of the objects at the start. Its side is 1 m, or twice
    // the diagonal of the objects' bounding box if that is longer.
    bool table = true;
    double table_height_m = 0;
    std::string camera_path;  // file of stamped poses of the camera, x right, y down, z forward
    PoseDirection pose_direction = PoseDirection::camera_to_world;
    // Moves the target to the middle of the objects at the start, and the camera along its line of sight, so
    // that they fill the image, or are as near as the sensor measures. Without effect on a camera with a
    // path.
    bool camera_fit = true;
  };

  // Throws as load(const PlacedMesh&, ...) does.
  MeshSceneFromFiles(const Settings& settings, const NoiseKey& key, const Kernels& kernels);

  // "husky: 5316 triangles, 0.200 x 0.042 x 0.143 m; camera at (0.00, 0.31, 0.22) m; path.txt: 12 poses over
  // 1.1 s at 10 Hz, 0.3 m long, at most 0.5 m/s"
  std::string input() const override { return input_; }
  // Notes on the files of poses, and on objects out of view.
  std::vector<Note> input_notes() const override;

 private:
  struct Parts {
    std::vector<SceneMesh> meshes;
    std::optional<PosePath> camera_path;
    MeshScene::Settings scene;
    std::string input;
    std::vector<Note> notes;
  };
  static Parts read(const Settings& settings);
  MeshSceneFromFiles(Parts parts, const NoiseKey& key, const Kernels& kernels);

  std::string input_;
  std::vector<Note> notes_;
};

Parameters parameters(MeshSceneFromFiles::Settings& s);
std::string validate(const MeshSceneFromFiles::Settings& s);
std::vector<InputPart> input_files(const MeshSceneFromFiles::Settings& s);

// A recording as a scenario whose true surface may come from mesh files.
class RecordingWithTruth final : public RecordedScene {
 public:
  using Settings = RecordedScene::Settings;
  RecordingWithTruth(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
      : RecordedScene(settings, key, kernels,
                      [](const std::filesystem::path& file) { return read_mesh(file); }) {}
};

}  // namespace remote_touch
