# A folder of the project is a room: one library of all its .cpp files, one place for its tests (the same path below
# tests/), and a list of the rooms that it may include. tests/system/check_layers holds every #include against that list.

set_property(GLOBAL PROPERTY ROOMS "")

# The name of the library of a room: core/dissertation/tool_motion is core_dissertation_tool_motion.
function(room_target path result)
  string(REPLACE "/" "_" name ${path})
  set(${result} ${name} PARENT_SCOPE)
endfunction()

# The method reads no files: libFuzzer need not count where it comes by, which takes half of the time of its tests.
# What is precompiled for the other rooms counts, and clang++ refuses it here.
function(without_coverage name path)
  if(REMOTE_TOUCH_FUZZ AND path MATCHES "^(core|tests)/")
    target_compile_options(${name} PRIVATE -fno-sanitize=fuzzer-no-link)
    set_target_properties(${name} PROPERTIES DISABLE_PRECOMPILE_HEADERS ON)
  endif()
endfunction()

# room(USES core/points core/kernels ... [LINKS PNG::PNG ...] [SOURCES generated.cpp ...] [COLD])
#   USES     the rooms whose headers this folder includes
#   LINKS    libraries from outside; they stay private, since no public header includes one
#   SOURCES  files beyond the .cpp files of the folder
#   COLD     runs spend little time in this room; -O1 cuts its compile time to two thirds
function(room)
  cmake_parse_arguments(ROOM COLD "" "USES;LINKS;SOURCES" ${ARGN})
  file(RELATIVE_PATH path ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  room_target(${path} name)
  file(GLOB sources CONFIGURE_DEPENDS *.cpp)
  add_library(${name} STATIC ${sources} ${ROOM_SOURCES})
  precompile_headers_as(room_headers ${name})
  target_link_libraries(${name} PUBLIC build_settings PRIVATE ${ROOM_LINKS})
  if(ROOM_COLD)
    target_compile_options(${name} PRIVATE $<$<CONFIG:Release,RelWithDebInfo>:-O1>)
  endif()
  without_coverage(${name} ${path})
  room_under_sanitizers(${path} ${name})
  foreach(used ${ROOM_USES})
    room_target(${used} target)
    target_link_libraries(${name} PUBLIC ${target})
  endforeach()
  set_property(GLOBAL APPEND PROPERTY ROOMS ${path})
  links_of(${path} ${ROOM_LINKS})
endfunction()

# links_of(runners/presentation ZLIB::ZLIB ...): what a program has to link that uses this room installed.
function(links_of path)
  string(REGEX MATCH "^[a-z]+" top ${path})
  set_property(GLOBAL APPEND PROPERTY LINKS_OF_${top} ${ARGN})
endfunction()

# rooms(core geometry kernels ... rivals): the rooms below this folder, and `core`, which links them all.
function(rooms name)
  add_library(${name} INTERFACE)
  foreach(path ${ARGN})
    add_subdirectory(${path})
    room_target(${name}/${path} target)
    target_link_libraries(${name} INTERFACE ${target})
  endforeach()
endfunction()
