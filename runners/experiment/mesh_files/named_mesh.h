// Meshes that a user names: built-in ones and files.
#pragma once

#include <string>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "scenarios/recordings/recording_part.h"

namespace remote_touch {

// "dog, husky, ...": the names of the meshes that need no file, see generated_tools.h.
std::string names_of_built_in_meshes();

// Returns why this can be no name of a mesh, in one line; empty if it can. parameter: its name.
std::string mesh_name_problem(const std::string& parameter, const std::string& name);

// Returns the file on which the mesh depends; none for a built-in mesh or an empty name.
std::vector<RecordingPart> mesh_files_of(const std::string& name);

// Returns the path of the mesh file, searched for as find_recording() does. Throws MissingRecording about the
// parameter if there is none.
std::string find_mesh_file(const std::string& parameter, const std::string& name);

// Returns the mesh in the unit of its file; a built-in mesh is in metres and takes precedence over a file of
// its name. Throws as find_mesh_file() and read_mesh().
TriangleMesh mesh_named(const std::string& parameter, const std::string& name);

}  // namespace remote_touch
