#include "scenarios/recordings/static_transforms.h"

#include "scenarios/text_files/refuse.h"

namespace remote_touch {

std::string plain_frame(const std::string& frame) {
  return frame.starts_with('/') ? frame.substr(1) : frame;
}

void StaticTransforms::add(const std::vector<StampedTransform>& transforms, const std::string& subject) {
  constexpr std::size_t kMaxFrames = 10000;
  for (const StampedTransform& transform : transforms) {
    parent_of_[plain_frame(transform.child)] = {plain_frame(transform.parent), transform.X};
    if (parent_of_.size() > kMaxFrames)
      refuse(subject, "has too many coordinate frames: expected at most ", kMaxFrames);
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
  refuse(subject, "tf_static has '", frame, "' as its own ancestor");
}

RigidTransform StaticTransforms::between(const std::string& to, const std::string& from,
                                         const std::string& subject) const {
  if (plain_frame(to) == plain_frame(from)) return RigidTransform::Identity();
  std::string root_of_to, root_of_from;
  const RigidTransform X_root_to = to_root(plain_frame(to), root_of_to, subject);
  const RigidTransform X_root_from = to_root(plain_frame(from), root_of_from, subject);
  if (root_of_to == root_of_from) return X_root_to.inverse() * X_root_from;
  std::string known;
  for (const auto& [child, parent] : parent_of_) {
    if (known.size() > 500) break;
    known += (known.empty() ? "" : ", ") + child + " in " + parent.name;
  }
  refuse(subject, "scenario.frame_id = ", to, ": expected a frame that tf_static connects with '", from,
         "'; it has ", (known.empty() ? "none" : known));
}

}  // namespace remote_touch
