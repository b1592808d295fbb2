// The tables of one level whose kernels are in several files.
#include "core/kernels/depth_kernels.h"
#include "core/kernels/level.h"
#include "core/kernels/proxy_kernels.h"
#include "core/kernels/tool_kernels.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

Kernel<&DepthKernels::depth_to_points> depth_to_points;
Kernel<&DepthKernels::filter_depth> filter_depth;
Kernel<&DepthKernels::plane_normals> plane_normals;
Kernel<&DepthKernels::inverse_depth_normals> inverse_depth_normals;
Kernel<&DepthKernels::sharp_normals> sharp_normals;
Kernel<&DepthKernels::points_to_cloud> points_to_cloud;
Kernel<&DepthKernels::normals_to_cloud> normals_to_cloud;

const DepthKernels kDepthKernels = {
    .depth_to_points = depth_to_points,
    .filter_depth = filter_depth,
    .plane_normals = plane_normals,
    .inverse_depth_normals = inverse_depth_normals,
    .sharp_normals = sharp_normals,
    .points_to_cloud = points_to_cloud,
    .normals_to_cloud = normals_to_cloud,
};

Kernel<&ProxyKernels::contact_query> contact_query;
Kernel<&ProxyKernels::first_hit> first_hit;
Kernel<&ProxyKernels::exit_distance> exit_distance;

const ProxyKernels kProxyKernels = {
    .contact_query = contact_query,
    .first_hit = first_hit,
    .exit_distance = exit_distance,
};

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
