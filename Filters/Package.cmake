# find_package(IPIA) from the build and the install tree.
include(CMakePackageConfigHelpers)
set(ipia_cmake_destination "${CMAKE_INSTALL_LIBDIR}/cmake/IPIA")
configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/IPIAConfig.cmake.in"
  "${CMAKE_BINARY_DIR}/${ipia_cmake_destination}/IPIAConfig.cmake"
  INSTALL_DESTINATION "${ipia_cmake_destination}")
write_basic_package_version_file(
  "${CMAKE_BINARY_DIR}/${ipia_cmake_destination}/IPIAConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES
  "${CMAKE_BINARY_DIR}/${ipia_cmake_destination}/IPIAConfig.cmake"
  "${CMAKE_BINARY_DIR}/${ipia_cmake_destination}/IPIAConfigVersion.cmake"
  DESTINATION "${ipia_cmake_destination}")
