// depth_kernels.cl, compiled into the program.
#pragma once

namespace remote_touch {

extern const char* const kDepthKernelSource;

}  // namespace remote_touch
