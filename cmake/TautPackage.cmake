# cpack makes taut_VERSION_ARCHITECTURE.deb: programs, libraries, headers, CMake package, configuration, sample, manual
# pages, completion and documentation. docs/package.md tells how; tests/package.sh checks what comes out.
#
# One package, not one more for development as Debian's libraries have it. Who uses taut often writes plug-ins too, one file
# to copy is easier than two, and the headers are small. What they need besides is small as well (12 MB): it is
# recommended, so that `apt install` brings it along and `--no-install-recommends` leaves it out.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME ${PROJECT_NAME})
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "The taut authors")
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "LiDAR-IMU SLAM that undistorts every point in every iteration")
set(CPACK_PACKAGE_DESCRIPTION
    "taut makes a map and a trajectory from the recording of a 3D LiDAR and an IMU. Every point is undistorted again in
each iteration of the optimisation; loops are closed. Programs import, check, simulate, calibrate, merge and score
recordings; each run leaves a page for a browser.")
# All but the plug-in for rawlog-grabber: its drivers would make everybody install Qt and wxWidgets.
set(CPACK_INSTALL_CMAKE_PROJECTS "${CMAKE_BINARY_DIR};${PROJECT_NAME};Unspecified;/")
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/package/finish.cmake)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
# Depends: what the programs and libraries link, by dpkg-shlibdeps. It finds taut's own libraries in the build folder.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_LIBRARY_OUTPUT_DIRECTORY})
# Packages of plug-ins depend on the version they were built with: before 1.0 the plug points may change.
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY "=")
# What tautConfig.cmake looks for, with its versions.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS
    "libeigen3-dev (>= 3.4), libmrpt-core-dev (>= 1:2.5), libmrpt-rtti-dev (>= 1:2.5), robin-map-dev (>= 1.2), liboctomap-dev (>= 1.9)"
)
# To build a plug-in; for taut-evaluate --plot; to look at map.bt.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "g++, cmake, gnuplot-nox, octovis")
include(CPack)
