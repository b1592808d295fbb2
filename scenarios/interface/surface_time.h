// The time at which a surface that moves is considered.
#pragma once

namespace remote_touch {

// newest_frame: the surface as at the last capture. moving: the surface as it moves between frames.
enum class SurfaceTime { newest_frame, moving };

}  // namespace remote_touch
