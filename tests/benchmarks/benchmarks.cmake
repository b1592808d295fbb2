# Included by tests/CMakeLists.txt: the paths are from there, and the programs beside the tests.
set(CMAKE_UNITY_BUILD OFF)  # the naive versions have the names of what they stand beside
find_package(benchmark REQUIRED)
find_package(NLopt QUIET)
add_executable(proxy_benchmark
  benchmarks/checked_benchmark.cpp benchmarks/naive_proxy.cpp benchmarks/proxy_benchmark.cpp)
target_link_libraries(proxy_benchmark PRIVATE runners benchmark::benchmark)
if(TARGET NLopt::nlopt)
  target_link_libraries(proxy_benchmark PRIVATE NLopt::nlopt)
  target_compile_definitions(proxy_benchmark PRIVATE REMOTE_TOUCH_NLOPT)
endif()
add_executable(map_benchmark
  benchmarks/checked_benchmark.cpp benchmarks/map_benchmark.cpp benchmarks/naive_proxy.cpp)
target_link_libraries(map_benchmark PRIVATE runners benchmark::benchmark)

add_executable(tool_benchmark
  benchmarks/checked_benchmark.cpp benchmarks/tool_benchmark.cpp benchmarks/tool_scene.cpp)
target_link_libraries(tool_benchmark PRIVATE core benchmark::benchmark)

add_executable(sphere_tree_benchmark
  benchmarks/checked_benchmark.cpp benchmarks/sphere_tree_benchmark.cpp benchmarks/tool_scene.cpp)
target_link_libraries(sphere_tree_benchmark PRIVATE core benchmark::benchmark)

add_executable(depth_benchmark
  benchmarks/checked_benchmark.cpp benchmarks/depth_benchmark.cpp core/dissertation/depth/reference_depth_pipeline.cpp)
target_link_libraries(depth_benchmark PRIVATE core benchmark::benchmark)

# Benchmarks beside others' libraries are built only when asked for, and say so where those are not installed.
function(peers_missing name packages)
  add_custom_target(${name} COMMAND ${CMAKE_COMMAND} -E echo "${name} needs ${packages}"
                    COMMAND ${CMAKE_COMMAND} -E false VERBATIM)
endfunction()

# The searches of others.
find_path(NANOFLANN_INCLUDE_DIR nanoflann.hpp)
find_package(PCL QUIET COMPONENTS common search kdtree)
if(PCL_FOUND AND NANOFLANN_INCLUDE_DIR)
  add_executable(peer_search_benchmark EXCLUDE_FROM_ALL
    benchmarks/checked_benchmark.cpp benchmarks/peers/peer_search_benchmark.cpp)
  target_include_directories(peer_search_benchmark SYSTEM PRIVATE ${PCL_INCLUDE_DIRS} ${NANOFLANN_INCLUDE_DIR})
  target_link_libraries(peer_search_benchmark PRIVATE core benchmark::benchmark ${PCL_LIBRARIES})
else()
  peers_missing(peer_search_benchmark "libpcl-dev and libnanoflann-dev")
endif()

# The normals of others. Their headers get none of our settings.
find_package(PCL QUIET COMPONENTS common search kdtree features)
find_package(OpenCV QUIET COMPONENTS core rgbd)
if(PCL_FOUND AND OpenCV_FOUND)
  add_library(peer_depth OBJECT EXCLUDE_FROM_ALL benchmarks/peers/peer_depth.cpp)
  target_include_directories(peer_depth PRIVATE ${PROJECT_SOURCE_DIR})
  target_include_directories(peer_depth SYSTEM PRIVATE ${PCL_INCLUDE_DIRS} ${OpenCV_INCLUDE_DIRS})
  target_link_libraries(peer_depth PRIVATE Eigen3::Eigen OpenMP::OpenMP_CXX)
  target_compile_options(peer_depth PRIVATE -O3)
  add_executable(peer_depth_benchmark EXCLUDE_FROM_ALL
    benchmarks/checked_benchmark.cpp benchmarks/peers/peer_depth_benchmark.cpp $<TARGET_OBJECTS:peer_depth>)
  target_link_libraries(peer_depth_benchmark PRIVATE core benchmark::benchmark ${PCL_LIBRARIES} ${OpenCV_LIBS})
else()
  peers_missing(peer_depth_benchmark "libpcl-dev, libopencv-dev and libopencv-contrib-dev")
endif()

# The collision detection of others, likewise.
find_package(Bullet QUIET)
find_package(fcl QUIET)
find_package(octomap QUIET)
if(BULLET_FOUND AND fcl_FOUND AND octomap_FOUND)
  add_library(peer_tool OBJECT EXCLUDE_FROM_ALL benchmarks/peers/peer_tool.cpp)
  target_include_directories(peer_tool PRIVATE ${PROJECT_SOURCE_DIR})
  target_include_directories(peer_tool SYSTEM PRIVATE ${BULLET_INCLUDE_DIRS})
  target_link_libraries(peer_tool PRIVATE fcl)
  target_compile_options(peer_tool PRIVATE -O3)
  add_executable(peer_tool_benchmark EXCLUDE_FROM_ALL
    benchmarks/checked_benchmark.cpp benchmarks/peers/peer_tool_benchmark.cpp benchmarks/tool_scene.cpp
    $<TARGET_OBJECTS:peer_tool>)
  target_link_libraries(peer_tool_benchmark PRIVATE core benchmark::benchmark fcl ${BULLET_LIBRARIES})
else()
  peers_missing(peer_tool_benchmark "libbullet-dev, libfcl-dev and liboctomap-dev")
endif()
