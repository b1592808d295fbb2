#include "runners/presentation/view/viewer_files.h"

#ifdef VIEWER_SCRIPT
// The assembler reads the files; as texts in C++ they would take a minute to compile.
// clang-format off
asm(".section .rodata\n"
    "viewer_script_begin:\n.incbin \"" VIEWER_SCRIPT "\"\nviewer_script_end:\n"
    "viewer_style_begin:\n.incbin \"" VIEWER_STYLE "\"\nviewer_style_end:\n"
    ".globl viewer_script_begin, viewer_script_end, viewer_style_begin, viewer_style_end\n"
    ".previous\n");
// clang-format on
// NOLINTNEXTLINE(readability-identifier-naming): symbols of the assembler
extern "C" const char viewer_script_begin[], viewer_script_end[], viewer_style_begin[], viewer_style_end[];
#endif

namespace remote_touch {

#ifdef VIEWER_SCRIPT
std::string_view viewer_script() {
  return {viewer_script_begin, viewer_script_end};
}
std::string_view viewer_style() {
  return {viewer_style_begin, viewer_style_end};
}
#else
std::string_view viewer_script() {
  return {};
}
std::string_view viewer_style() {
  return {};
}
#endif

}  // namespace remote_touch
