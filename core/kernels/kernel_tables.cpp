// The table of the kernels of a tool at one level, which are in several files.
#include "core/kernels/level.h"
#include "core/kernels/tool_kernels.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

Kernel<&ToolKernels::near_spheres> near_spheres;
Kernel<&ToolKernels::slabs_in_field> slabs_in_field;
Kernel<&ToolKernels::slabs_on_way> slabs_on_way;
Kernel<&ToolKernels::points_in_cells> points_in_cells;
Kernel<&ToolKernels::disks_in_field> disks_in_field;
Kernel<&ToolKernels::points_in_field> points_in_field;
Kernel<&ToolKernels::touched_points> touched_points;
Kernel<&ToolKernels::disk_contacts> disk_contacts;

const ToolKernels kToolKernels = {
    .near_spheres = near_spheres,
    .slabs_in_field = slabs_in_field,
    .slabs_on_way = slabs_on_way,
    .points_in_cells = points_in_cells,
    .disks_in_field = disks_in_field,
    .points_in_field = points_in_field,
    .touched_points = touched_points,
    .disk_contacts = disk_contacts,
};

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
