// The method alone, in a loop of a user's own: it uses no experiment and no file.
#include <core/dissertation/proxy/proxy_renderer.h>
#include <core/kernels/kernels.h>

#include <cstdio>

int main() {
  using namespace remote_touch;
  PointCloud cloud;
  for (int i = -20; i <= 20; ++i)
    for (int j = -20; j <= 20; ++j) cloud.append({0.0015 * i, 0, 0.0015 * j});
  ProxyRenderer renderer({}, 1000, kernels_for(best_isa()));
  renderer.on_frame({0, 0, 0, make_search(std::move(cloud))});
  RenderOutput out;
  for (int tick = 0; tick < 100; ++tick)
    out = renderer.step({Vec3(0, 0.02 - 0.0003 * tick, 0)}, 0.001 * tick);
  std::printf("%.3f N up, proxy %.2f mm above the points\n", out.force_N.y(), 1000 * out.proxy_W.y());
  return out.force_N.y() > 1 ? 0 : 1;
}
