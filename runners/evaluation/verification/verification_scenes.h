// The scenes in which every renderer is checked.
#pragma once

#include <vector>

#include "core/kernels/kernels.h"
#include "runners/evaluation/verification/metamorphic_scene.h"

namespace remote_touch {

// 320 ticks at 1024 Hz each, with clouds at 32 Hz that arrive 5 ticks late: all times are whole multiples of
// 1/1024 s, so they stay exact when they are halved or shifted by whole seconds. A proxy of about 5 mm on
// points 1.5 mm apart is pressed most of the time. Every surface is tilted and every point displaced from its
// lattice, so that no comparison in a renderer is a tie that rounding decides. The same bits on every machine
// and for all kernels.
std::vector<MetamorphicScene> verification_scenes(const Kernels& kernels);

}  // namespace remote_touch
