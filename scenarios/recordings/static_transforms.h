// Fixed transforms between the coordinate frames of a robot, as in tf_static: each frame has at most one
// parent.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/messages.h"

namespace remote_touch {

// Removes the leading / that older programs write in front of the name of a frame.
std::string plain_frame(const std::string& frame);

class StaticTransforms {
 public:
  // A frame that is added again gets its new parent and transform. Throws InputError about the subject for
  // more than 10000 frames.
  void add(const std::vector<StampedTransform>& transforms, const std::string& subject = "tf_static");
  // p_to = X * p_from. Throws InputError about the subject when the two are not connected, or a frame is its
  // own ancestor.
  RigidTransform between(const std::string& to, const std::string& from, const std::string& subject) const;

 private:
  struct Parent {
    std::string name;
    RigidTransform X;
  };
  // Returns the transform from the frame to its root, the ancestor without a parent, and writes the root's
  // name. Throws InputError about the subject if a frame is its own ancestor.
  RigidTransform to_root(std::string frame, std::string& root, const std::string& subject) const;

  std::map<std::string, Parent> parent_of_;
};

}  // namespace remote_touch
