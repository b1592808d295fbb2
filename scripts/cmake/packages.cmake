# cpack -G DEB: remote-touch (the program), libremote-touch-dev (headers and libraries), python3-remote-touch (the module,
# where it is built). scripts/packages calls it.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME remote-touch)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "The Remote Touch authors <remote-touch@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)

set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME remote-touch)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "haptic rendering of streaming point clouds: simulation and evaluation
 Computes the force that a hand feels when it touches a scene that only a depth camera sees. Runs experiments, sweeps and
 comparisons of renderers without a haptic device, and checks the figures of a dissertation.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
# draws figures: scripts/plot of the sources; not needed to make them
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "python3-remote-touch, python3-h5py, python3-matplotlib")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libremote-touch-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "haptic rendering of streaming point clouds: libraries and headers
 For programs with renderers, scenarios and measures of their own: static libraries, headers, files for CMake and pkg-config.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${package_libraries}")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "libgtest-dev, remote-touch")

if(TARGET remote_touch_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-remote-touch)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "haptic rendering of streaming point clouds: module for Python
 Runs experiments and sweeps, reads results as xarray datasets, takes renderers and scenarios in Python.")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3, python3-numpy, python3-xarray")
endif()
include(CPack)
