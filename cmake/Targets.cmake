include(GNUInstallDirs)

# Cached results belong to the build that computed them.
add_link_options(LINKER:--build-id)

# A shared library per layer, of all sources in its folder and below, but for main.cc and for folders with libraries of
# their own:
#   annulus_add_layer(core PUBLIC ... PRIVATE ... PRECOMPILE <Eigen/Core>)
# PRECOMPILE names headers of other libraries that most sources include and that take long to read.
function(annulus_add_layer name)
  cmake_parse_arguments(ARG "" "" "PUBLIC;PRIVATE;PRECOMPILE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cc)
  file(GLOB_RECURSE libraries CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*/CMakeLists.txt)
  foreach(library ${libraries})
    get_filename_component(folder ${library} DIRECTORY)
    list(FILTER sources EXCLUDE REGEX "^${folder}/")
  endforeach()
  list(FILTER sources EXCLUDE REGEX "/main\\.cc$|/systems/skeleton/")
  add_library(annulus_${name} SHARED ${sources})
  target_include_directories(annulus_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                             $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/annulus>)
  target_link_libraries(annulus_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  annulus_finish_library(${name} ${ARG_PRECOMPILE})
endfunction()

# A library that core/loaded_library.h loads when it is needed, of the sources in its folder:
#   annulus_add_loaded_library(elements LAYER fem PRIVATE annulus_dealii)
function(annulus_add_loaded_library name)
  cmake_parse_arguments(ARG "" "LAYER" "PRIVATE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cc)
  add_library(annulus_${name} SHARED ${sources})
  target_link_libraries(annulus_${name} PUBLIC annulus_${ARG_LAYER} PRIVATE ${ARG_PRIVATE})
  annulus_finish_library(${name})
  set_property(GLOBAL APPEND PROPERTY ANNULUS_LOADED_LIBRARIES annulus_${name})
endfunction()

# For programs: nothing that they link builds the libraries that they load.
function(annulus_needs_loaded_libraries program)
  get_property(libraries GLOBAL PROPERTY ANNULUS_LOADED_LIBRARIES)
  add_dependencies(${program} ${libraries})
endfunction()

function(annulus_finish_library name)
  annulus_set_warnings(annulus_${name})
  if(ARGN)
    target_precompile_headers(annulus_${name} PRIVATE ${ARGN})
  endif()
  # The layers that a scene or a table reaches before a solve guide the fuzzer.
  if(ANNULUS_CHECKED AND name MATCHES "^(core|geometry|app)$")
    target_compile_options(annulus_${name} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
endfunction()

function(annulus_set_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                         $<$<BOOL:${ANNULUS_WARNINGS_AS_ERRORS}>:-Werror>)
endfunction()

# For programs that handle text and files, or check what others computed: a third of their compile time was optimisation.
function(annulus_optimise_little target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# Limit of a test's time in seconds: the largest of its labels. Ten times as much under the sanitizers.
set(ANNULUS_TIMEOUT_unit 120)
set(ANNULUS_TIMEOUT_verification 300)
set(ANNULUS_TIMEOUT_pipeline 300)
set(ANNULUS_TIMEOUT_extremes 300)
set(ANNULUS_TIMEOUT_slow 1200)
set(ANNULUS_TIMEOUT_benchmark 1200)
set(ANNULUS_TIMEOUT_nightly 10800)

# Labels of a test and its timeout:
#   annulus_label_test(fem.hertz verification fem)
# Kinds: unit, verification, pipeline, extremes, benchmark. Layers: core, geometry, fem, dynamics, app.
# slow: more than 20 s of processor time. nightly: hours in all. CMakePresets.json selects by these labels.
function(annulus_label_test name)
  set(timeout 0)
  foreach(label IN LISTS ARGN)
    if(DEFINED ANNULUS_TIMEOUT_${label} AND ANNULUS_TIMEOUT_${label} GREATER timeout)
      set(timeout ${ANNULUS_TIMEOUT_${label}})
    endif()
  endforeach()
  if(timeout EQUAL 0)
    message(FATAL_ERROR "${name}: no timeout for any of the labels ${ARGN}")
  endif()
  if(ANNULUS_CHECKED)
    math(EXPR timeout "10 * ${timeout}")
  endif()
  set_tests_properties(${name} PROPERTIES LABELS "${ARGN}" TIMEOUT ${timeout})
endfunction()

# What tests compare with independent references, for the verification manual (tests/verification_record.h).
set(ANNULUS_VERIFICATION_RECORDS ${PROJECT_BINARY_DIR}/verification)

# One test program of all sources in the folder and below, one CTest entry per Boost.Test suite:
#   annulus_add_tests(core LAYER core LINK annulus_core SUITES unit:csv verification+slow:periodic_curve)
# Each entry of SUITES is labels:suite. NAME.suites fails when a suite of the sources is not listed. LAYER is the label of
# all entries; without it, entries have only their own labels.
function(annulus_add_tests name)
  cmake_parse_arguments(ARG "" "LAYER" "LINK;PRECOMPILE;SUITES" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cc)
  add_executable(test_${name} ${sources})
  annulus_needs_loaded_libraries(test_${name})
  target_link_libraries(test_${name} PRIVATE annulus_test_main ${ARG_LINK} Boost::unit_test_framework)
  target_compile_definitions(test_${name} PRIVATE ANNULUS_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  # Each test case runs with traps: the header comes before every source, precompiled or not.
  if(CMAKE_DISABLE_PRECOMPILE_HEADERS)
    target_compile_options(test_${name} PRIVATE -include ${PROJECT_SOURCE_DIR}/tests/floating_point_traps.h)
  else()
    target_precompile_headers(test_${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests/floating_point_traps.h ${ARG_PRECOMPILE})
  endif()
  annulus_optimise_little(test_${name})
  annulus_set_warnings(test_${name})
  set(suites "")
  foreach(entry IN LISTS ARG_SUITES)
    string(REPLACE ":" ";" parts ${entry})
    list(GET parts 0 labels)
    list(GET parts 1 suite)
    string(REPLACE "+" ";" labels ${labels})
    list(GET labels 0 kind)
    list(APPEND suites ${suite})
    add_test(NAME ${name}.${suite} COMMAND test_${name} --run_test=${suite} --log_level=test_suite)
    annulus_label_test(${name}.${suite} ${labels} ${ARG_LAYER})
    set_tests_properties(${name}.${suite} PROPERTIES
                         ENVIRONMENT "ANNULUS_VERIFICATION_RECORD=${ANNULUS_VERIFICATION_RECORDS};ANNULUS_CACHE=")
    if(NOT name STREQUAL app)
      set_tests_properties(${name}.${suite} PROPERTIES FIXTURES_REQUIRED verification_records)
      set_property(GLOBAL APPEND PROPERTY ANNULUS_TEST_ENTRIES "${kind} ${name} ${suite} $<TARGET_FILE:test_${name}>")
      set_property(GLOBAL APPEND PROPERTY ANNULUS_RECORDING_TESTS ${name}.${suite})
    endif()
  endforeach()
  add_test(NAME ${name}.suites COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:test_${name}> "-DLISTED=${suites}"
                                       -P ${PROJECT_SOURCE_DIR}/cmake/CheckSuites.cmake)
  annulus_label_test(${name}.suites unit ${ARG_LAYER})
endfunction()
