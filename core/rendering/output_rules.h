// Choices that the proxy and the tool share: the velocity term of the force, and the command of the slave
// robot.
#pragma once

namespace remote_touch {

enum class VelocityForce { minus, plus, none };  // sign of the velocity term of (4.15); plus is printed
// Pose that the slave robot follows, 5.2. rendered: that of the proxy or tool, a hard constraint. hip: that
// of the device, a soft constraint.
enum class SlaveCommand { rendered, hip };

}  // namespace remote_touch
