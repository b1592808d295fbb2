# Writes OUTPUT, a header that says from what the program was built; untouched when nothing changed.
cmake_policy(VERSION 3.25)
execute_process(COMMAND git rev-parse HEAD WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE commit
  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
set(dirty "unknown")
if(failed)
  set(commit "unknown")
else()
  execute_process(COMMAND git status --porcelain -- . ":(exclude)data/baselines" ":(exclude)data/benchmarks" WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE changes ERROR_QUIET)
  if(changes)
    set(dirty "yes")
  else()
    set(dirty "no")
  endif()
endif()
# What the program was made from, committed or not: builds with equal SHA-256 are of equal sources. Of data/ all but
# what is made by the program and drawn from it is compiled in.
set(patterns ${SOURCE}/scripts/cmake/*.cmake ${SOURCE}/data/*.json)
list(APPEND patterns ${SOURCE}/runners/presentation/page/style.css
     ${SOURCE}/runners/presentation/page/bundle/viewer.js ${SOURCE}/scripts/plotting/*.json)
foreach(folder core scenarios analysis runners)
  list(APPEND patterns ${SOURCE}/${folder}/*.h ${SOURCE}/${folder}/*.cpp ${SOURCE}/${folder}/CMakeLists.txt)
endforeach()
file(GLOB_RECURSE files RELATIVE ${SOURCE} ${patterns})
list(FILTER files EXCLUDE REGEX "^data/(baselines|benchmarks|pictures)/")
list(SORT files)
set(sums "")
foreach(file ${files} CMakeLists.txt)
  file(SHA256 ${SOURCE}/${file} sum)
  string(APPEND sums "${sum}  ${file}\n")
endforeach()
string(SHA256 sources "${sums}")
string(REGEX REPLACE " +" " " FLAGS "${FLAGS}")
string(STRIP "${FLAGS}" FLAGS)
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT
"#define REMOTE_TOUCH_VERSION \"@VERSION@\"
#define REMOTE_TOUCH_GIT_COMMIT \"@commit@\"
#define REMOTE_TOUCH_GIT_DIRTY \"@dirty@\"
#define REMOTE_TOUCH_SOURCES \"@sources@\"
#define REMOTE_TOUCH_COMPILER \"@COMPILER@\"
#define REMOTE_TOUCH_FLAGS \"@FLAGS@\"
")
