#include "core/dissertation/tool/contact/kept_groups.h"

#include <algorithm>
#include <limits>

namespace remote_touch {

void KeptGroups::reserve(std::size_t padded_size) {
  groups_.grow(padded_size / kLanes + 1), nearest_m_.grow(padded_size / kLanes + kLanes);
  searched_m_ = -1;
}

void KeptGroups::search(const TouchFinder& finder, const ToolPose& pose, double reach_m) {
  searched_at_ = pose, searched_m_ = remote_touch::searched_m(reach_m, kSpare_m);
  const TiledCloud& cloud = finder.cloud().packed();
  is_new_ = true;
  const std::span<const std::uint32_t> found =
      cloud.has_slabs() ? finder.slabs_within(cloud, pose, searched_m_, nearest_m_.data())
                        : finder.groups_within(cloud, pose, searched_m_);
  count_ = found.size();
  if (!cloud.has_slabs())
    std::fill_n(nearest_m_.data(), count_, -std::numeric_limits<double>::infinity());  // not known
  std::copy(found.begin(), found.end(), groups_.data());
}

// Drops the groups without a point within searched_m_.
void KeptGroups::drop_far_groups() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    groups_[kept] = groups_[i], nearest_m_[kept] = nearest_m_[i];
    kept += nearest_m_[i] > searched_m_ ? 0 : 1;
  }
  count_ = kept;
}

GroupsInReach KeptGroups::within(const TouchFinder& finder, const ToolPose& pose, double reach_m) {
  if (!(searched_m_ - max_change_m(finder, searched_at_, pose) > reach_m)) search(finder, pose, reach_m);
  is_new_ = is_new_ && pose == searched_at_;  // nearest_m_ belongs to that pose
  return {groups_.data(), count_, nearest_m_.data(), is_new_,
          remote_touch::passed_m(reach_m, max_change_m(finder, searched_at_, pose))};
}

void KeptGroups::on_measured() {
  if (is_new_) drop_far_groups();
  is_new_ = false;
}

}  // namespace remote_touch
