#include "runners/evaluation/verification/metamorphic_scene.h"

#include <memory>

#include "core/search/neighbour_search.h"

namespace remote_touch {

namespace {

std::shared_ptr<const NeighbourSearch> search_of(const PointCloud& cloud, double cell_m) {
  if (cloud.image) return std::make_shared<ImageWindowSearch>(cloud);
  if (cell_m > 0) return std::make_shared<UniformGridSearch>(cloud, cell_m);
  return std::make_shared<BruteForceSearch>(cloud);
}

}  // namespace

std::vector<RenderOutput> play(const MetamorphicScene& scene, Renderer& renderer) {
  std::vector<RenderOutput> outputs;
  outputs.reserve(scene.hip_W.size());
  auto view = scene.views.begin();
  for (std::size_t tick = 0; tick < scene.hip_W.size(); ++tick) {
    const double time_s = scene.time_s(tick);
    for (; view != scene.views.end() && view->arrives_s <= time_s; ++view)
      renderer.on_frame(
          {view->index, view->captured_s, view->arrives_s, search_of(view->cloud, scene.cell_m)});
    outputs.push_back(renderer.step({scene.hip_W[tick], scene.device_WH[tick]}, time_s));
  }
  return outputs;
}

}  // namespace remote_touch
