// The viewer's script and style, which the build made of runners/presentation/view/page and put into the
// program.
#pragma once

#include <string_view>

namespace remote_touch {

// Both empty in a program that was built without Node.
std::string_view viewer_script();
std::string_view viewer_style();

}  // namespace remote_touch
