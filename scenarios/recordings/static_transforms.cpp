#include "scenarios/recordings/static_transforms.h"

#include "core/parameters/input_error.h"

namespace remote_touch {
namespace {

// Removes the leading / that older programs write.
std::string plain(const std::string& frame) {
  return frame.starts_with('/') ? frame.substr(1) : frame;
}

}  // namespace

void StaticTransforms::add(const std::vector<StampedTransform>& transforms) {
  constexpr std::size_t kMaxFrames = 10000;
  for (const StampedTransform& transform : transforms) {
    if (parent_of_.size() == kMaxFrames) return;
    parent_of_[plain(transform.child)] = {plain(transform.parent), transform.X};
  }
}

RigidTransform StaticTransforms::to_root(std::string frame, std::string& root,
                                         const std::string& subject) const {
  RigidTransform X = RigidTransform::Identity();
  for (std::size_t steps = 0; steps <= parent_of_.size(); ++steps) {
    const auto parent = parent_of_.find(frame);
    if (parent == parent_of_.end()) {
      root = frame;
      return X;
    }
    X = parent->second.X * X, frame = parent->second.name;
  }
  throw InputError(subject, "tf_static has '" + frame + "' as its own ancestor");
}

RigidTransform StaticTransforms::between(const std::string& to, const std::string& from,
                                         const std::string& subject) const {
  if (plain(to) == plain(from)) return RigidTransform::Identity();
  std::string root_of_to, root_of_from;
  const RigidTransform X_root_to = to_root(plain(to), root_of_to, subject);
  const RigidTransform X_root_from = to_root(plain(from), root_of_from, subject);
  if (root_of_to == root_of_from) return X_root_to.inverse() * X_root_from;
  std::string known;
  for (const auto& [child, parent] : parent_of_) {
    if (known.size() > 500) break;
    known += (known.empty() ? "" : ", ") + child + " in " + parent.name;
  }
  throw InputError(subject, "scenario.frame_id = " + to +
                                ": expected a frame that tf_static connects with '" + from + "'; it has " +
                                (known.empty() ? "none" : known));
}

}  // namespace remote_touch
