# Every dependency is a Debian package (see scripts/install_packages.sh); nothing is downloaded.

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(Boost 1.74 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(CLI11 REQUIRED)
find_package(pugixml REQUIRED)
find_package(SUNDIALS 6 REQUIRED)
find_package(pagmo 2.18 REQUIRED)
find_package(BLAS REQUIRED)
find_package(LAPACK REQUIRED)
find_package(Threads REQUIRED)
find_package(ZLIB REQUIRED)
if(ANNULUS_BUILD_TESTS)
  find_package(Boost 1.74 REQUIRED COMPONENTS unit_test_framework)
endif()

# gmsh, CHOLMOD and FFTW ship no CMake files in Debian 12.
find_path(GMSH_INCLUDE_DIR gmsh.h REQUIRED)
find_library(GMSH_LIBRARY gmsh REQUIRED)
add_library(annulus_gmsh INTERFACE)
target_include_directories(annulus_gmsh SYSTEM INTERFACE ${GMSH_INCLUDE_DIR})
target_link_libraries(annulus_gmsh INTERFACE ${GMSH_LIBRARY})

find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
add_library(annulus_cholmod INTERFACE)
target_include_directories(annulus_cholmod SYSTEM INTERFACE ${CHOLMOD_INCLUDE_DIR})
target_link_libraries(annulus_cholmod INTERFACE ${CHOLMOD_LIBRARY} LAPACK::LAPACK BLAS::BLAS)

find_path(FFTW_INCLUDE_DIR fftw3.h REQUIRED)
find_library(FFTW_LIBRARY fftw3 REQUIRED)
add_library(annulus_fftw INTERFACE)
target_include_directories(annulus_fftw SYSTEM INTERFACE ${FFTW_INCLUDE_DIR})
target_link_libraries(annulus_fftw INTERFACE ${FFTW_LIBRARY})

# deal_ii_setup_target() would bring Debian's public debug flags and make every file slower to compile,
# so the library is described here: headers as system headers, the release library, nothing else.
find_package(deal.II 9.4 REQUIRED)
add_library(annulus_dealii INTERFACE)
target_include_directories(annulus_dealii SYSTEM INTERFACE ${DEAL_II_INCLUDE_DIRS})
target_compile_definitions(annulus_dealii INTERFACE BOOST_NO_AUTO_PTR)
find_library(DEAL_II_RELEASE_LIBRARY NAMES deal.ii deal_II HINTS ${DEAL_II_PATH}/lib REQUIRED)
# deal.II's headers inline calls into oneTBB.
find_package(TBB REQUIRED)
target_link_libraries(annulus_dealii INTERFACE ${DEAL_II_RELEASE_LIBRARY} TBB::tbb)

# Of exports. The serial HDF5, as matio has it; deal.II brings the one with MPI, whose symbols are versioned apart.
find_package(PkgConfig REQUIRED)
pkg_check_modules(HDF5_SERIAL REQUIRED IMPORTED_TARGET hdf5-serial)
find_library(HDF5_SERIAL_HL_LIBRARY hdf5_serial_hl HINTS ${HDF5_SERIAL_LIBRARY_DIRS} REQUIRED)
add_library(annulus_hdf5 INTERFACE)
target_link_libraries(annulus_hdf5 INTERFACE ${HDF5_SERIAL_HL_LIBRARY} PkgConfig::HDF5_SERIAL)
pkg_check_modules(RSVG REQUIRED IMPORTED_TARGET librsvg-2.0)
pkg_check_modules(MATIO REQUIRED IMPORTED_TARGET matio)
add_library(annulus_matio INTERFACE)
target_link_libraries(annulus_matio INTERFACE PkgConfig::MATIO)

# Inlined in reports when they are written.
find_package(ZLIB REQUIRED)
find_file(ANNULUS_PAKO_JS pako_inflate.min.js PATHS /usr/share/nodejs/pako/dist NO_DEFAULT_PATH REQUIRED)
find_file(ANNULUS_CHART_JS chart.min.js PATHS /usr/share/javascript/chart.js NO_DEFAULT_PATH REQUIRED)
find_file(ANNULUS_THREE_JS three.min.js PATHS /usr/share/javascript/three NO_DEFAULT_PATH REQUIRED)
find_file(ANNULUS_ORBIT_JS OrbitControls.js PATHS /usr/share/javascript/three/examples/js/controls NO_DEFAULT_PATH REQUIRED)
