// The viewer's script and style, which the build made from runners/presentation/view/page and embedded in the
// program.
#pragma once

#include <string_view>

namespace remote_touch {

// Both empty in a program that was built without Node.
std::string_view viewer_script();
std::string_view viewer_style();

}  // namespace remote_touch
