// The scene of a trace for ParaView and VTK.
#pragma once

#include "runners/presentation/export/export_job.h"

namespace remote_touch {

// x.vtp: the paths of the HIP and of the proxy as two lines, with the columns of the trace at each point.
// x_cloud_0000.vtp ...: the measured points of each frame in use. Points of unknown colour are grey; if there
// are some, has_colour is 0 for them and 1 for the others.
// x_tool_0000.vtp ...: the tool at its pose in the first tick that used the frame.
// x_cloud.vtp.series, x_tool.vtp.series: the names of these files with their times, as ParaView reads them.
// x.pvd: everything over time.
void write_vtp(const ExportJob& job);

}  // namespace remote_touch
