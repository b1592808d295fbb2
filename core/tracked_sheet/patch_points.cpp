#include "core/tracked_sheet/patch_points.h"

namespace remote_touch {

void PatchPoints::take(const GatheredPoints& gathered, const PatchRegion& region) {
  place.clear(), source.clear();
  const PointsView all = gathered.view();
  for (std::size_t i = 0; i < gathered.size(); ++i) {
    const PatchPlace p = region.frame.place(Vec3(all.x[i], all.y[i], all.z[i]));
    if (!region.holds(p)) continue;  // nor where nothing was measured
    place.push_back(p), source.push_back(static_cast<std::uint32_t>(i));
  }
  member.assign(place.size(), 0);
  residual.assign(place.size(), 0);
}

}  // namespace remote_touch
