# What `cmake --install` and `cpack` put where: the program with its manual page, completions and scenes, and the
# libraries with their headers and CMake package files.

get_property(loaded_libraries GLOBAL PROPERTY ANNULUS_LOADED_LIBRARIES)
set(libraries annulus_core annulus_geometry annulus_fem annulus_dynamics)
set_target_properties(annulus_cli PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
set_target_properties(${libraries} annulus_app ${loaded_libraries} PROPERTIES INSTALL_RPATH "$ORIGIN")
install(TARGETS annulus_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/data/scenes ${PROJECT_SOURCE_DIR}/data/cases DESTINATION ${CMAKE_INSTALL_DATADIR}/annulus)
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)

# The program writes its completions, help2man its manual page.
set(generated ${PROJECT_BINARY_DIR}/generated)
file(MAKE_DIRECTORY ${generated})
add_custom_command(
  OUTPUT ${generated}/annulus.bash ${generated}/_annulus ${generated}/annulus.fish
  COMMAND annulus_cli completion bash > ${generated}/annulus.bash
  COMMAND annulus_cli completion zsh > ${generated}/_annulus
  COMMAND annulus_cli completion fish > ${generated}/annulus.fish
  DEPENDS annulus_cli VERBATIM)
find_program(HELP2MAN help2man REQUIRED)
add_custom_command(
  OUTPUT ${generated}/annulus.1
  COMMAND ${HELP2MAN} --no-info --help-option=--help-all --section=1
          --name "ring gear flexibility, from structure to planetary dynamics" --output=${generated}/annulus.1
          --include=${PROJECT_SOURCE_DIR}/cmake/annulus.h2m
          $<TARGET_FILE:annulus_cli>
  DEPENDS annulus_cli ${PROJECT_SOURCE_DIR}/cmake/annulus.h2m VERBATIM)
add_custom_target(annulus_generated ALL
                  DEPENDS ${generated}/annulus.bash ${generated}/_annulus ${generated}/annulus.fish ${generated}/annulus.1)
install(FILES ${generated}/annulus.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME annulus)
install(FILES ${generated}/_annulus DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(FILES ${generated}/annulus.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
install(FILES ${generated}/annulus.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)

# The layers below the application as libraries: find_package(annulus), annulus::annulus_dynamics.
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/annulus)
install(TARGETS ${libraries} EXPORT annulusTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS annulus_app ${loaded_libraries} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT annulusTargets NAMESPACE annulus:: DESTINATION ${package_folder})
foreach(layer core geometry fem dynamics)
  # Not those of loaded libraries, which show deal.II and gmsh.
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${layer} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/annulus
          FILES_MATCHING PATTERN "*.h" PATTERN dealii EXCLUDE PATTERN gmsh EXCLUDE PATTERN pagmo EXCLUDE)
endforeach()
include(CMakePackageConfigHelpers)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/annulusConfig.cmake.in ${generated}/annulusConfig.cmake
                              INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${generated}/annulusConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${generated}/annulusConfig.cmake ${generated}/annulusConfigVersion.cmake DESTINATION ${package_folder})

# cpack --preset release, or cpack -G DEB in the build folder: annulus_<version>_<architecture>.deb
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME annulus)
set(CPACK_PACKAGE_CONTACT "The annulus developers")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# What shared libraries do not tell: the scripts that reports contain.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libjs-chart.js, libjs-three, node-pako")
# The module for Python is built for Debian's.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libopenblas0-pthread, python3-pandas, python3-xarray, python3-matplotlib")
# For who builds against the libraries.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS
    "libeigen3-dev, nlohmann-json3-dev, libboost-dev")
set(CPACK_STRIP_FILES ON)
include(CPack)
