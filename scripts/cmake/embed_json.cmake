# Writes JSON files of data/ into the program, so that one binary is all a user has to carry. FILES: a list, OUTPUT: the
# C++ file, FUNCTION: of runners/settings/embedded_data.h, which returns them. The name of each is its file's without the ending.
set(text "// Written by the build from data/; edit those files.\n#include \"runners/settings/embedded_data.h\"\n\n")
string(APPEND text "namespace remote_touch {\n\nnamespace {\nconstexpr StoredText kTexts[] = {\n")
foreach(file ${FILES})
  get_filename_component(name ${file} NAME)
  string(REGEX REPLACE "\\.json$" "" name ${name})
  file(READ ${file} json)
  string(APPEND text "    {\"${name}\", R\"json(${json})json\"},\n")
endforeach()
string(APPEND text "};\n}  // namespace\n\nstd::span<const StoredText> ${FUNCTION}() { return kTexts; }\n\n")
string(APPEND text "}  // namespace remote_touch\n")
file(WRITE ${OUTPUT} "${text}")
