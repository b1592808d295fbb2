// The depth pipeline written down plainly in double precision: loops over windows, Eigen's eigenvectors.
#pragma once

#include <vector>

#include "core/dissertation/depth/depth_pipeline.h"

namespace remote_touch {

struct ReferenceDepth {
  PointCloud cloud;
  // Eigenvalues of the covariance of each point as fractions of their sum. gap is the middle one minus the
  // smallest; if it is small, the normal is undetermined. middle is the middle one; if it is small, the
  // points define no plane.
  std::vector<double> gap, middle;
  // The normals that single precision may choose. If edges are sharp, they are those whose planes have
  // equally small errors; otherwise there is only the cloud's normal.
  std::vector<std::vector<Vec3>> as_good;
};

ReferenceDepth reference_depth_pipeline(const DepthPipelineSettings& settings, const DepthImage& depth,
                                        const CameraIntrinsics& camera, const RigidTransform& X_WC);

}  // namespace remote_touch
