// Meshes from files: OBJ, PLY and STL.
#pragma once

#include <filesystem>

#include "analysis/storage/other_processes.h"
#include "core/mesh/triangle_mesh.h"

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

}  // namespace remote_touch
