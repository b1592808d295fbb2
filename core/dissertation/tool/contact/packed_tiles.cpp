// The packed() cloud of a dense one, with the slabs of its groups.
#include <algorithm>

#include "core/dissertation/tool/contact/group_slab.h"
#include "core/dissertation/tool/contact/tiled_cloud.h"
#include "core/search/compact_order.h"

namespace remote_touch {

void TiledCloud::pack() {
  std::vector<Vec3> places;
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t i = 0; i < x_.size(); ++i)
    if (x_[i] != kFarAway) places.push_back(point(i)), numbers.push_back(i);
  std::vector<std::uint32_t> order = compact_order(places);
  for (std::uint32_t& i : order) i = numbers[i];
  packed_ = std::make_unique<TiledCloud>();
  packed_->assign_packed(*this, order);
}

void TiledCloud::assign_packed(const TiledCloud& all, std::span<const std::uint32_t> points) {
  for (std::size_t i = 0; i < points.size(); i += kTilePoints) {
    const auto first = static_cast<std::uint32_t>(x_.size());
    for (const std::uint32_t k : points.subspan(i, std::min<std::size_t>(kTilePoints, points.size() - i))) {
      add_point({all.point(k), all.normal(k), all.spacing_m(k)});
      number_.push_back(k);
    }
    finish_tile(first);
  }
  number_.resize(x_.size(), 0);
  extent_m_.assign(x_.size(), 0);
  gather_slabs();
  finish();
}

// Replaces the bounding spheres of the groups by slabs, whose spheres have the same centres and radii.
void TiledCloud::gather_slabs() {
  group_spheres_.clear();
  std::vector<Vec3> points, normals;
  for (std::uint32_t first = 0; first < x_.size(); first += kLanes) {
    points.clear(), normals.clear();
    for (std::uint32_t i = first; i < first + kLanes; ++i)
      if (x_[i] != kFarAway) points.push_back(point(i)), normals.push_back(normal(i));
    const GroupSlab slab =
        points.empty() ? GroupSlab{Vec3::Constant(kFarAway), Vec3::Zero(), 0, 0} : group_slab(points);
    group_spheres_.add({slab.centre_W, slab.radius_m});
    const NormalCone cone = normal_cone(normals);
    const double values[] = {slab.n_W.x(),      slab.n_W.y(),      slab.n_W.z(),      slab.half_m,
                             cone.middle_W.x(), cone.middle_W.y(), cone.middle_W.z(), cone.deviation};
    for (std::size_t k = 0; k < slabs_.size(); ++k) slabs_[k].push_back(values[k]);
  }
}

}  // namespace remote_touch
