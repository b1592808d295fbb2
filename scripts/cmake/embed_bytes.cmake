# Writes files into the program, byte by byte. FILES: a list, OUTPUT: the C++ file, HEADER: what declares FUNCTION and
# EmbeddedFile. Each is named as its file, without the ending.
set(text "// Written by the build from data/.\n#include \"${HEADER}\"\n\nnamespace remote_touch {\n\n")
string(APPEND text "std::span<const EmbeddedFile> ${FUNCTION}() {\n  static constexpr EmbeddedFile files[] = {\n")
foreach(file ${FILES})
  get_filename_component(name ${file} NAME_WE)
  file(READ ${file} bytes HEX)
  string(LENGTH "${bytes}" digits)
  math(EXPR size "${digits} / 2")
  string(REGEX REPLACE "(..)" "\\\\x\\1" bytes "${bytes}")
  string(APPEND text "    {\"${name}\", {\"${bytes}\", ${size}}},\n")
endforeach()
string(APPEND text "  };\n  return files;\n}\n\n}  // namespace remote_touch\n")
file(WRITE ${OUTPUT} "${text}")
