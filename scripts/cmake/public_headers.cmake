# The public headers: those that are named here, and what they include. Only these are installed.
# runners/interfaces/cli/own_program.md says what they are for.

set(public_headers
  analysis/storage/trace_comparison.h analysis/storage/result_file.h analysis/trace/measures.h
  analysis/storage/hdf5_file.h analysis/trace/trace.h core/beyond/tracked_surface/tracked_renderers.h
  core/dissertation/proxy/proxy_renderer.h core/dissertation/virtual_fixtures/fixture_rules.h core/points/point_cloud.h
  core/points/vector.h core/kernels/kernels.h core/points/noise.h
  core/parameters/parameter.h core/rendering/renderer.h
  core/points/neighbour_search.h
  runners/evaluation/verification/metamorphic_checks.h runners/experiment/catalog/catalog.h
  runners/experiment/catalog/experiment.h runners/experiment/hand/trajectory.h
  runners/experiment/simulation/simulation.h runners/interfaces/cli/program.h
  runners/interfaces/plugins/plugin_library.h runners/interfaces/plugins/remote_touch_plugin.h
  scenarios/simulated/scenario.h)
if(TARGET runners_evaluation_contract)
  list(APPEND public_headers runners/evaluation/contract/contract_tests.h)
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
