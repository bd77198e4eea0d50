# taut_add_module(name SOURCES ... [DEPENDS ...] [PRIVATE_DEPENDS ...])
#
# One library a module: headers in include/taut/<name>, sources in src. Stage modules depend on
# taut::core and on outside libraries only; odometry alone joins them.
function(taut_add_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  add_library(taut_${name} ${ARG_SOURCES})
  add_library(taut::${name} ALIAS taut_${name})
  target_include_directories(
    taut_${name} PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
                        $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(taut_${name} PUBLIC ${ARG_DEPENDS} PRIVATE ${ARG_PRIVATE_DEPENDS}
                                                                  $<BUILD_INTERFACE:taut_options>)
  set_target_properties(taut_${name} PROPERTIES EXPORT_NAME ${name} VERSION ${PROJECT_VERSION}
                                                SOVERSION ${PROJECT_VERSION_MAJOR}
                                                INSTALL_RPATH "$ORIGIN")
  install(TARGETS taut_${name} EXPORT tautTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endfunction()

# taut_add_app(name SOURCES ... DEPENDS ...): a program, thin over the modules. It prints its manual page and its
# completion itself. They are made by running it, but not with a sanitizer, which would run at every build.
function(taut_add_app name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_DEPENDS} taut_options)
  target_compile_definitions(${name} PRIVATE TAUT_VERSION="${PROJECT_VERSION}")
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  set_property(GLOBAL APPEND PROPERTY TAUT_PROGRAMS ${name})
  if(TAUT_SANITIZE)
    return()
  endif()
  set(page ${CMAKE_BINARY_DIR}/share/man/man1/${name}.1)
  set(completion ${CMAKE_BINARY_DIR}/share/bash-completion/completions/${name})
  add_custom_command(
    OUTPUT ${page} ${completion}
    COMMAND ${name} --print-manual-page > ${page}
    COMMAND ${name} --print-bash-completion > ${completion}
    DEPENDS ${name}
    COMMENT "Writing manual page and completion of ${name}"
    VERBATIM)
  add_custom_target(${name}_manual ALL DEPENDS ${page} ${completion})
  install(FILES ${page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  install(FILES ${completion} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
endfunction()

# taut_add_test(name SOURCES ... [DEPENDS ...] [LABELS ...] [PROPERTIES ...]): a GoogleTest program, one
# ctest entry a test.
function(taut_add_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;LABELS;PROPERTIES" ${ARGN})
  if(NOT ARG_LABELS)
    set(ARG_LABELS unit)  # an empty value would take the next word for the label
  endif()
  add_executable(test_${name} ${ARG_SOURCES})
  target_include_directories(test_${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests/support)
  target_link_libraries(test_${name} PRIVATE ${ARG_DEPENDS} GTest::gtest_main GTest::gmock
                                             taut_options)
  target_compile_definitions(
    test_${name} PRIVATE TAUT_DATA_DEFAULT="${PROJECT_SOURCE_DIR}/../shared/data")
  gtest_discover_tests(
    test_${name}
    TEST_PREFIX "${name}."
    DISCOVERY_TIMEOUT 60
    NO_PRETTY_VALUES
    PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT 600 ${ARG_PROPERTIES})
endfunction()
