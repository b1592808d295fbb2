# The public headers: those that are named here, and what they include. Only these are installed.
# runners/program/README.md says what they are for.

set(public_headers
  core/cloud/point_cloud.h core/cloud/camera.h core/geometry/vector.h core/geometry/rotation.h core/kernels/isa.h
  core/parameters/input_error.h core/parameters/parameter.h core/proxy/proxy_renderer.h core/random/noise.h
  core/rendering/frame.h core/rendering/frame_order.h core/rendering/frame_preparation.h core/rendering/renderer.h
  core/search/neighbour_search.h core/tracked_sheet/tracked_sheet_renderer.h core/virtual_fixtures/fixture_rule.h
  scenarios/interface/scenario.h
  analysis/comparison/column_source.h analysis/figures/result_file.h analysis/measures/measures.h
  analysis/storage/hdf5_file.h analysis/trace/trace.h
  runners/cli/program.h runners/experiment/catalog.h runners/experiment/experiment.h
  runners/plugins/plugin_library.h runners/plugins/remote_touch_plugin.h runners/simulation/simulation.h runners/trajectories/trajectory.h)
if(TARGET runners_contract)
  list(APPEND public_headers runners/contract/contract_tests.h)
endif()

# Sets `result` to the headers of the project that are reached from the given ones by #include "...", themselves included.
function(reached_headers result)
  set(left ${ARGN})
  set(seen "")
  while(left)
    list(POP_FRONT left header)
    if(header IN_LIST seen)
      continue()
    endif()
    list(APPEND seen ${header})
    file(STRINGS ${PROJECT_SOURCE_DIR}/${header} lines REGEX "^#include \"")
    foreach(line ${lines})
      string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" included ${line})
      list(APPEND left ${included})
    endforeach()
  endwhile()
  set(${result} ${seen} PARENT_SCOPE)
endfunction()
