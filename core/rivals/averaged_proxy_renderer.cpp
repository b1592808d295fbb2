#include "core/rivals/averaged_proxy_renderer.h"

namespace remote_touch {

Parameters parameters(AveragedProxyParameters& p) {
  return appended(parameters(p.proxy), parameters(p.average));
}

std::string validate(const AveragedProxyParameters& p) {
  const std::string average = validate(p.average);
  return average.empty() ? validate(p.proxy) : average;
}

void AveragedProxyRenderer::reserve(std::size_t points) {
  proxy_.reserve(points);
  average_.reserve(points);
}

void AveragedProxyRenderer::on_frame(const Frame& frame) {
  if (!proxy_.is_newer(frame)) return proxy_.on_frame(frame);
  proxy_.on_frame({frame.index, frame.captured_s, frame.arrives_s, average_.next(*frame.points)});
}

}  // namespace remote_touch
