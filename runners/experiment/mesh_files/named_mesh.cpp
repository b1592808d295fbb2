#include "runners/experiment/mesh_files/named_mesh.h"

#include "core/dissertation/tool/shape/generated_tools.h"
#include "runners/experiment/mesh_files/mesh_file.h"

namespace remote_touch {

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

std::vector<RecordingPart> mesh_files_of(const std::string& name) {
  if (name.empty() || find_generated_tool(name) != nullptr) return {};
  return {{name}};
}

std::string find_mesh_file(const std::string& parameter, const std::string& name) {
  try {
    return find_recording(name);
  } catch (const MissingRecording&) {
    throw MissingRecording(parameter + " = " + name, "no such mesh: expected " + names_of_built_in_meshes() +
                                                         ", or an OBJ, PLY or STL file " +
                                                         recording_places());
  }
}

TriangleMesh mesh_named(const std::string& parameter, const std::string& name) {
  if (const GeneratedTool* built_in = find_generated_tool(name)) return built_in->make();
  return read_mesh(find_mesh_file(parameter, name));
}

}  // namespace remote_touch
