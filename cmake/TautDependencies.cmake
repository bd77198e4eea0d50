# Every outside library of taut, with the Debian 12 package and version it was measured with.
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)  # libeigen3-dev 3.4.0
# libmrpt-maps-dev, libmrpt-opengl-dev, libmrpt-tclap-dev 2.5.8
foreach(lib core rtti system io serialization math poses obs maps img opengl tclap)
  find_package(mrpt-${lib} 2.5 REQUIRED)
endforeach()
find_package(yaml-cpp 0.7 REQUIRED)    # libyaml-cpp-dev 0.7.0
find_package(ZLIB 1.2 REQUIRED)          # zlib1g-dev 1.2.13
find_package(BZip2 1.0 REQUIRED)         # libbz2-dev 1.0.8: chunks of bags
find_package(SQLite3 3.40 REQUIRED)      # libsqlite3-dev 3.40.1: bags
# liblz4-dev 1.9.4, libzstd-dev 1.5.4: chunks of bags
foreach(lib lz4 zstd)
  find_library(${lib}_LIBRARY ${lib} REQUIRED)
endforeach()
find_path(lz4_INCLUDE_DIR lz4frame.h REQUIRED)
find_path(zstd_INCLUDE_DIR zstd.h REQUIRED)
find_package(liblzf 3.6 REQUIRED CONFIG) # liblzf-dev 3.6: compressed PCD files
find_package(octomap 1.9 REQUIRED)      # liboctomap-dev 1.9.7
find_package(NLopt 2.7 REQUIRED CONFIG) # libnlopt-cxx-dev 2.7.1
find_package(nanoflann 1.4 REQUIRED)    # libnanoflann-dev 1.4.3
find_package(tsl-robin-map 1.2 REQUIRED) # robin-map-dev 1.2.1
find_package(nlohmann_json 3.11 REQUIRED) # nlohmann-json3-dev 3.11.2
find_program(GNUPLOT_PROGRAM gnuplot) # gnuplot-nox 5.4.4, optional: taut-evaluate --plot calls it
if(NOT GNUPLOT_PROGRAM)
  message(STATUS "gnuplot (Debian: gnuplot-nox) is absent: taut-evaluate --plot will not draw")
endif()
find_package(OpenSSL 3.0 REQUIRED COMPONENTS Crypto) # libssl-dev 3.0
find_library(OSMESA_LIBRARY OSMesa REQUIRED) # libosmesa6-dev 22.3.6
find_path(OSMESA_INCLUDE_DIR GL/osmesa.h REQUIRED)
find_path(PCAP_INCLUDE_DIR pcap/pcap.h REQUIRED) # libpcap-dev 1.10.3
find_library(PCAP_LIBRARY pcap REQUIRED)
add_library(PCAP::PCAP INTERFACE IMPORTED)
set_target_properties(PCAP::PCAP PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${PCAP_INCLUDE_DIR}"
                                            INTERFACE_LINK_LIBRARIES "${PCAP_LIBRARY}")
# libjs-three 111: drawn with in report.html, which holds a copy (Expat licence). Its scripts for pages without modules
# went away with release 148.
find_path(THREE_FOLDER examples/js/controls/OrbitControls.js REQUIRED
          PATHS /usr/share/javascript/three /usr/share/nodejs/three NO_DEFAULT_PATH)
find_package(embree 3 QUIET) # libembree-dev 3.13.5; optional: simulation
# libmrpt-hwdrivers-dev 2.5.8, optional: sensors of taut-live; drivers for rawlog-grabber (mrpt-apps), which the tests run
find_package(mrpt-hwdrivers 2.5 QUIET)
if(NOT mrpt-hwdrivers_FOUND)
  message(STATUS "mrpt-hwdrivers (Debian: libmrpt-hwdrivers-dev) is absent: libtaut-grabber.so is not "
                 "built, taut-live plays recordings alone (cmake/install-dependencies.sh --grabber installs it)")
endif()

# Strict warnings, on an interface target so that no directory forgets them.
add_library(taut_options INTERFACE)
target_compile_options(taut_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                       -Wold-style-cast -Woverloaded-virtual -Wconversion -Wno-sign-conversion)
if(TAUT_WARNINGS_AS_ERRORS)
  target_compile_options(taut_options INTERFACE -Werror)
endif()
if(TAUT_SANITIZE)
  target_compile_options(taut_options INTERFACE -fsanitize=${TAUT_SANITIZE}
                         -fno-omit-frame-pointer -fno-sanitize-recover=all
                         # Checks of every pointer in every inlined function of Eigen double the time
                         # of compilation. The address sanitizer ends a null pointer as well.
                         -fno-sanitize=null,alignment)
  target_link_options(taut_options INTERFACE -fsanitize=${TAUT_SANITIZE})
endif()
if(TAUT_FUZZ)
  # Every branch is counted, so that the fuzzer knows new ones. MRPT has no type information for checks of `vptr`.
  target_compile_options(taut_options INTERFACE -fsanitize=fuzzer-no-link,float-cast-overflow -fno-sanitize=vptr)
  target_link_options(taut_options INTERFACE -fno-sanitize=vptr)
endif()
