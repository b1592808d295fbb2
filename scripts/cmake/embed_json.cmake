# Writes the experiments into the program, so that one binary is all a user has to carry. FILES: a list of JSON files,
# OUTPUT: the C++ file. The name of an experiment is its file's name without the ending.
set(text "// Written by the build from data/experiments; edit those files.\n#include \"runners/experiment.h\"\n\n")
string(APPEND text "namespace remote_touch {\n\nnamespace {\nconstexpr StoredExperiment kExperiments[] = {\n")
foreach(file ${FILES})
  get_filename_component(name ${file} NAME)
  string(REGEX REPLACE "\\.json$" "" name ${name})
  file(READ ${file} json)
  string(APPEND text "    {\"${name}\", R\"json(${json})json\"},\n")
endforeach()
string(APPEND text "};\n}  // namespace\n\nstd::span<const StoredExperiment> stored_experiments() { return kExperiments; }\n\n")
string(APPEND text "}  // namespace remote_touch\n")
file(WRITE ${OUTPUT} "${text}")
