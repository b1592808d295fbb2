// Meshes from files, OBJ, PLY and STL, and meshes that a user names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/storage/other_processes.h"
#include "core/mesh/triangle_mesh.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {

// Meshes from files: OBJ, PLY and STL.

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

// "dog, husky, ...": the names of the meshes that need no file, see generated_tools.h.
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

}  // namespace remote_touch
