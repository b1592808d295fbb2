// The table of the proxy kernels of one level.
#include "core/kernels/proxy_kernels.h"
#include "core/kernels/level.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

Kernel<&ProxyKernels::contact_query> contact_query;
Kernel<&ProxyKernels::first_hit> first_hit;
Kernel<&ProxyKernels::exit_distance> exit_distance;

const ProxyKernels kProxyKernels = {
    .contact_query = contact_query,
    .first_hit = first_hit,
    .exit_distance = exit_distance,
};

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
