// What a renderer can need of the points of its frames. Without it there would be no force, or a wrong one,
// so a run is refused.
#pragma once

namespace remote_touch {

enum class FrameNeed {
  normals,    // of the points
  organised,  // rows and columns, so that the neighbours of a point are known
  regions,    // forbidden regions around points, or a target of guidance
  view        // where the sensor looks: an image, or a setting `view`
};

}  // namespace remote_touch
