// The table of the depth kernels of one level.
#include "core/kernels/depth_kernels.h"
#include "core/kernels/level.h"

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

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
