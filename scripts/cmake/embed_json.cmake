# Writes JSON files of data/ into the program, so that one binary is all a user has to carry. FILES: a list, OUTPUT: the
# C++ file, FUNCTION: of runners/experiment/settings/changed_settings.h, which returns them. Each is named as its file,
# without the ending.
set(text "// Written by the build from data/; edit those files.\n#include \"runners/experiment/settings/changed_settings.h\"\n\n")
string(APPEND text "namespace remote_touch {\n\nstd::span<const EmbeddedText> ${FUNCTION}() {\n  static constexpr EmbeddedText texts[] = {\n")
foreach(file ${FILES})
  get_filename_component(name ${file} NAME)
  string(REGEX REPLACE "\\.json$" "" name ${name})
  file(READ ${file} json)
  string(APPEND text "    {\"${name}\", R\"json(${json})json\"},\n")
endforeach()
string(APPEND text "  };\n  return texts;\n}\n\n")
string(APPEND text "}  // namespace remote_touch\n")
file(WRITE ${OUTPUT} "${text}")
