# cmake --install: the program, and the rooms as one static library for each top folder, for find_package(remote_touch).
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)
include(${CMAKE_CURRENT_LIST_DIR}/public_headers.cmake)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/remote_touch)
set(header_folder ${CMAKE_INSTALL_INCLUDEDIR}/remote_touch)

# installed_library(NAME ROOMS room ... USES other_name ... LINKS library ...): remote_touch::NAME, of the objects of rooms.
function(installed_library name)
  cmake_parse_arguments(LIBRARY "" "" "ROOMS;USES;LINKS" ${ARGN})
  set(target remote_touch_${name})
  add_library(${target} STATIC)
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} LINKER_LANGUAGE CXX)
  foreach(path ${LIBRARY_ROOMS})
    room_target(${path} room)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${room}>)
  endforeach()
  target_include_directories(${target} INTERFACE $<INSTALL_INTERFACE:${header_folder}>)
  # Eigen's alignment depends on the first, equal bits in a program's own code on the second.
  target_compile_definitions(${target} INTERFACE EIGEN_DONT_VECTORIZE)
  target_compile_options(${target} INTERFACE -ffp-contract=off)
  target_compile_features(${target} INTERFACE cxx_std_20)
  list(TRANSFORM LIBRARY_USES PREPEND remote_touch_)
  list(REMOVE_DUPLICATES LIBRARY_LINKS)
  target_link_libraries(${target} INTERFACE ${LIBRARY_USES} ${LIBRARY_LINKS})
  install(TARGETS ${target} EXPORT remote_touch-${name} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
  install(EXPORT remote_touch-${name} NAMESPACE remote_touch:: DESTINATION ${package_folder} COMPONENT development)
endfunction()

get_property(all_rooms GLOBAL PROPERTY ROOMS)
foreach(top core scenarios analysis runners)
  set(rooms_of_${top} ${all_rooms})
  list(FILTER rooms_of_${top} INCLUDE REGEX "^${top}/")
  get_property(links_of_${top} GLOBAL PROPERTY LINKS_OF_${top})
endforeach()
list(REMOVE_ITEM rooms_of_runners runners/evaluation/contract runners/interfaces/python)
# CLI11: headers only, in no header of ours
list(REMOVE_ITEM links_of_runners GTest::gtest CLI11::CLI11 pybind11::headers Python::Module)

installed_library(core ROOMS ${rooms_of_core} LINKS Eigen3::Eigen OpenMP::OpenMP_CXX)
get_property(kernel_objects GLOBAL PROPERTY KERNEL_OBJECTS)
foreach(kernels ${kernel_objects})
  target_sources(remote_touch_core PRIVATE $<TARGET_OBJECTS:${kernels}>)
endforeach()
installed_library(scenarios ROOMS ${rooms_of_scenarios} USES core LINKS ${links_of_scenarios})
installed_library(analysis ROOMS ${rooms_of_analysis} USES core LINKS ${links_of_analysis} Threads::Threads)
installed_library(runners ROOMS ${rooms_of_runners} USES scenarios analysis core
                  LINKS ${links_of_runners} Threads::Threads -Wl,--as-needed)
if(TARGET runners_evaluation_contract)
  installed_library(contract_tests ROOMS runners/evaluation/contract USES runners LINKS GTest::gtest)
endif()

reached_headers(installed_headers ${public_headers})
foreach(header ${installed_headers})
  get_filename_component(folder ${header} DIRECTORY)
  install(FILES ${PROJECT_SOURCE_DIR}/${header} DESTINATION ${header_folder}/${folder} COMPONENT development)
endforeach()

# Those that the libraries above are linked to, beside Eigen and OpenMP.
set(package_dependencies nlohmann_json PNG ZLIB liblzf OpenSSL assimp Threads SQLite3 BZip2 PkgConfig)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/remote_touch-config.cmake.in
  ${PROJECT_BINARY_DIR}/generated/remote_touch-config.cmake INSTALL_DESTINATION ${package_folder})
# Before version 1 the interface may change with the minor version.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/generated/remote_touch-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/generated/remote_touch-config.cmake
  ${PROJECT_BINARY_DIR}/generated/remote_touch-config-version.cmake
  DESTINATION ${package_folder} COMPONENT development)
configure_file(${CMAKE_CURRENT_LIST_DIR}/remote_touch_core.pc.in ${PROJECT_BINARY_DIR}/generated/remote_touch_core.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/generated/remote_touch_core.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
  COMPONENT development)

install(TARGETS remote-touch RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
# The viewer's script contains packages of others.
set(licences_of_viewer ${PROJECT_SOURCE_DIR}/runners/presentation/page/bundle/LICENSES)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${licences_of_viewer})
file(READ ${PROJECT_SOURCE_DIR}/LICENSE licence)
file(READ ${licences_of_viewer} licences)
file(WRITE ${PROJECT_BINARY_DIR}/generated/copyright "${licence}\n${licences}")
set(components program development python)
set(packages remote-touch libremote-touch-dev python3-remote-touch)
foreach(component package IN ZIP_LISTS components packages)
  install(FILES ${PROJECT_BINARY_DIR}/generated/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package}
    COMPONENT ${component})
endforeach()

# Debian's packages of all that the libraries are linked to; of cameras what this build found.
set(package_libraries "libeigen3-dev, nlohmann-json3-dev, libhdf5-dev, libpng-dev, zlib1g-dev, liblzf-dev, libssl-dev, libassimp-dev, libsqlite3-dev, liblz4-dev, libzstd-dev, libbz2-dev, pkgconf")
if(TARGET openni2)
  string(APPEND package_libraries ", libopenni2-dev")
endif()
if(TARGET freenect)
  string(APPEND package_libraries ", libfreenect-dev")
endif()
include(${CMAKE_CURRENT_LIST_DIR}/packages.cmake)
