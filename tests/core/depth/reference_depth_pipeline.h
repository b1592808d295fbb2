// The depth pipeline written down plainly in double precision: loops over windows, Eigen's eigenvectors.
#pragma once

#include <vector>

#include "core/depth/depth_pipeline.h"

namespace remote_touch {

struct ReferenceDepth {
  PointCloud cloud;
  // Of the covariance of each point: its middle eigenvalue less the smallest, and the middle one, as shares
  // of the sum. Where the first is small no one can tell the normal, where the second is there is no plane.
  std::vector<double> gap, middle;
  // With sharp edges: the normals that single precision may choose, since their planes err as little. Else
  // that of the cloud.
  std::vector<std::vector<Vec3>> as_good;
};

ReferenceDepth reference_depth_pipeline(const DepthPipelineSettings& settings, const DepthImage& depth,
                                        const CameraIntrinsics& camera, const RigidTransform& X_WC);

}  // namespace remote_touch
