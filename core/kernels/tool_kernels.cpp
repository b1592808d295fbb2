// The table of the tool kernels of one level.
#include "core/kernels/tool_kernels.h"
#include "core/kernels/level.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

Kernel<&ToolKernels::near_spheres> near_spheres;
Kernel<&ToolKernels::points_in_cells> points_in_cells;
Kernel<&ToolKernels::disks_in_field> disks_in_field;
Kernel<&ToolKernels::points_in_field> points_in_field;
Kernel<&ToolKernels::touched_points> touched_points;
Kernel<&ToolKernels::disk_contacts> disk_contacts;

const ToolKernels kToolKernels = {
    .near_spheres = near_spheres,
    .points_in_cells = points_in_cells,
    .disks_in_field = disks_in_field,
    .points_in_field = points_in_field,
    .touched_points = touched_points,
    .disk_contacts = disk_contacts,
};

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
