// The properties that a renderer can require of the points of its frames. A run is refused if its frames lack
// one of them, because there would be no force, or a wrong one.
#pragma once

namespace remote_touch {

enum class FrameNeed {
  normals,    // points with normals
  organised,  // rows and columns, so that the neighbours of a point are known
  regions,    // forbidden regions around points, or a target of guidance
  view        // viewing direction of the sensor: an image, or a setting `view`
};

}  // namespace remote_touch
