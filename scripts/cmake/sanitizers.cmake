# Tests of some rooms under sanitizers, in the build folder of the release preset: each of these rooms is compiled a second
# time with the sanitizer, and all others are linked as they are. A sanitizer therefore sees only mistakes in these rooms. The
# test tests_under_sanitizers has a build of its own, of everything.
option(REMOTE_TOUCH_SANITIZED_TESTS "Build tests of some rooms under sanitizers" OFF)

# Rooms that read what others wrote or call libraries of others, and rooms where a sanitizer or a crash found a mistake.
set(rooms_under_address
  analysis/storage core/points runners/experiment/mesh_files runners/interfaces/plugins
  runners/libraries runners/live/devices runners/live/sensors scenarios/recordings
  scenarios/files)
# Rooms whose threads share memory.
set(rooms_under_thread
  runners/libraries runners/live/devices runners/live/loop runners/live/sensors)
# These include Boost.Beast and take half a minute to compile. haply_link.cpp is covered by the thread sanitizer, and both by
# the test tests_under_sanitizers.
set(sources_not_under_address haply_link)
set(sources_not_under_thread view_server)
# The other checks take a third of the time to compile, and the fuzz targets have them. Asserts are on; those of Eigen are
# not, since rooms without a sanitizer share its functions.
set(flags_for_address -UNDEBUG -DEIGEN_NO_DEBUG -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all -fno-omit-frame-pointer
  -fno-sanitize=null,object-size,vptr,alignment,pointer-overflow)
set(flags_for_thread -UNDEBUG -DEIGEN_NO_DEBUG -fsanitize=thread)

# compile_again(TARGET SANITIZER [REGEX]): TARGET_SANITIZER gets the sources of TARGET (those that match, if REGEX is given)
# with its options and the sanitizer. Called in the folder of TARGET, since properties of sources belong to a folder.
function(compile_again target sanitizer)
  get_target_property(sources ${target} SOURCES)
  if(ARGN)
    list(FILTER sources INCLUDE REGEX "${ARGN}")
  endif()
  if(sources_not_under_${sanitizer})
    list(FILTER sources EXCLUDE REGEX "${sources_not_under_${sanitizer}}")
  endif()
  target_sources(${target}_${sanitizer} PRIVATE ${sources})
  precompile_headers_as(headers_under_${sanitizer} ${target}_${sanitizer})
  target_compile_definitions(${target}_${sanitizer} PRIVATE $<TARGET_PROPERTY:${target},COMPILE_DEFINITIONS>)
  target_compile_options(${target}_${sanitizer} PRIVATE
    $<TARGET_PROPERTY:${target},COMPILE_OPTIONS> -O1 ${flags_for_${sanitizer}})
  target_include_directories(${target}_${sanitizer} PRIVATE ${PROJECT_SOURCE_DIR})
  target_include_directories(${target}_${sanitizer} SYSTEM PRIVATE $<TARGET_PROPERTY:${target},INCLUDE_DIRECTORIES>)
endfunction()

function(room_under_sanitizers path name)
  foreach(sanitizer address thread)
    if(REMOTE_TOUCH_SANITIZED_TESTS AND path IN_LIST rooms_under_${sanitizer})
      add_library(${name}_${sanitizer} OBJECT EXCLUDE_FROM_ALL)
      compile_again(${name} ${sanitizer})
    endif()
  endforeach()
endfunction()

if(REMOTE_TOUCH_SANITIZED_TESTS)
  foreach(sanitizer address thread)
    add_library(headers_under_${sanitizer} STATIC EXCLUDE_FROM_ALL scripts/cmake/room_headers.cpp)
    target_link_libraries(headers_under_${sanitizer} PRIVATE build_settings nlohmann_json::nlohmann_json)
    target_compile_options(headers_under_${sanitizer} PRIVATE -O1 ${flags_for_${sanitizer}})
    precompile_headers(headers_under_${sanitizer})
  endforeach()
endif()
