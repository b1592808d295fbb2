// Ticks after a frame whose points lie in the tool.
#pragma once

#include "core/dissertation/tool/dynamics/tool_parameters.h"
#include "tests/benchmarks/tool_scene.h"

namespace remote_touch::benchmarks {

// Adds benchmarks named tool_landing/...: the surface rises by 4 mm while the device presses the tool down,
// and goes back, again and again. The counters are the time of the tick that receives the frame, and the time
// of the slowest tick after it.
void add_landing(const ToolScene& scene, const ToolParameters& parameters, const char* rule);

}  // namespace remote_touch::benchmarks
