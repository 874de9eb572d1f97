include(GNUInstallDirs)

# One library per layer, of all sources in its folder and below, but for main.cc:
#   annulus_add_layer(core [SHARED] PUBLIC ... PRIVATE ...)
function(annulus_add_layer name)
  cmake_parse_arguments(ARG "SHARED" "" "PUBLIC;PRIVATE" ${ARGN})
  file(GLOB_RECURSE ARG_SOURCES CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cc)
  list(FILTER ARG_SOURCES EXCLUDE REGEX "/main\\.cc$")
  if(ARG_SHARED AND NOT ANNULUS_CHECKED)
    add_library(annulus_${name} SHARED ${ARG_SOURCES})
  else()
    add_library(annulus_${name} STATIC ${ARG_SOURCES})
  endif()
  target_include_directories(annulus_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                             $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/annulus>)
  target_link_libraries(annulus_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  annulus_set_warnings(annulus_${name})
  # The layers that a scene or a table reaches before a solve guide the fuzzer.
  if(ANNULUS_CHECKED AND name MATCHES "^(core|geometry|app)$")
    target_compile_options(annulus_${name} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
endfunction()

function(annulus_set_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                         $<$<BOOL:${ANNULUS_WARNINGS_AS_ERRORS}>:-Werror>)
endfunction()

# What tests compare with independent references, for the verification manual (tests/verification_record.h).
set(ANNULUS_VERIFICATION_RECORDS ${PROJECT_BINARY_DIR}/verification)

# One test program per layer, one CTest entry per Boost.Test suite:
#   annulus_add_tests(core LINK annulus_core SOURCES a.cc SUITES "unit:errors" "verification:hertz")
# Each entry of SUITES is label:suite; the suite must exist (an empty selection fails).
function(annulus_add_tests name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;LINK;SUITES" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  if(ANNULUS_CHECKED)
    math(EXPR ARG_TIMEOUT "10 * ${ARG_TIMEOUT}")
  endif()
  add_executable(test_${name} ${ARG_SOURCES})
  target_link_libraries(test_${name} PRIVATE annulus_test_main ${ARG_LINK} Boost::unit_test_framework)
  target_compile_definitions(test_${name} PRIVATE ANNULUS_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_compile_options(test_${name} PRIVATE -include ${PROJECT_SOURCE_DIR}/tests/floating_point_traps.h)
  annulus_set_warnings(test_${name})
  foreach(entry IN LISTS ARG_SUITES)
    string(REPLACE ":" ";" parts ${entry})
    list(GET parts 0 label)
    list(GET parts 1 suite)
    add_test(NAME ${name}.${suite} COMMAND test_${name} --run_test=${suite} --log_level=test_suite)
    set_tests_properties(${name}.${suite} PROPERTIES LABELS ${label} TIMEOUT ${ARG_TIMEOUT}
                         ENVIRONMENT ANNULUS_VERIFICATION_RECORD=${ANNULUS_VERIFICATION_RECORDS})
    if(NOT name STREQUAL app)
      set_property(GLOBAL APPEND PROPERTY ANNULUS_TEST_ENTRIES "${label} ${name} ${suite} $<TARGET_FILE:test_${name}>")
      set_property(GLOBAL APPEND PROPERTY ANNULUS_RECORDING_TESTS ${name}.${suite})
    endif()
  endforeach()
endfunction()
