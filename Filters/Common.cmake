# What all builds have in common: options, where things go, warnings.
include(CMakeDependentOption)
option(BUILD_SHARED_LIBS "Build shared libraries" ON)
option(IPIA_WRAP_PYTHON "Build the Python package ipia" ON)
option(IPIA_BUILD_TESTING "Build the tests" ON)
cmake_dependent_option(IPIA_BUILD_CORE_TESTS "With the tests, build those of the core" ON
  IPIA_BUILD_TESTING OFF)
option(IPIA_BUILD_EXAMPLES "Build the C++ examples" ON)
option(IPIA_BUILD_BENCHMARKS "Build the benchmarks (needs Google Benchmark)" OFF)
option(IPIA_WARNINGS_AS_ERRORS "Treat warnings in this project's own code as errors" OFF)
option(IPIA_BUILD_PARAVIEW_PLUGIN "Build the plugin for ParaView, and nothing else" OFF)
option(IPIA_CORE_ONLY "Build only the core and its tests, without VTK" OFF)
set(IPIA_SANITIZE "" CACHE STRING "Sanitizers for the core and its tests, such as address,undefined")

if (NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif ()

include(GNUInstallDirs)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_BINDIR}")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}")
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}")

set(ipia_warnings -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion)
if (IPIA_WARNINGS_AS_ERRORS)
  list(APPEND ipia_warnings -Werror)
endif ()

if (IPIA_BUILD_TESTING)
  enable_testing()
endif ()
