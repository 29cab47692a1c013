# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
#
# Install rules: the two libraries with their headers, the command, and a package for find_package(thalweg CONFIG).
include(CMakePackageConfigHelpers)

set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/thalweg")
configure_package_config_file(tools/cmake/thalwegConfig.cmake.in "${PROJECT_BINARY_DIR}/thalwegConfig.cmake"
                              INSTALL_DESTINATION "${package_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/thalwegConfigVersion.cmake" COMPATIBILITY SameMinorVersion)

install(
  TARGETS thalweg_core thalweg_parallel
  EXPORT thalweg
  FILE_SET HEADERS)
install(
  EXPORT thalweg
  NAMESPACE thalweg::
  FILE thalwegTargets.cmake
  DESTINATION "${package_dir}")
install(FILES "${PROJECT_BINARY_DIR}/thalwegConfig.cmake" "${PROJECT_BINARY_DIR}/thalwegConfigVersion.cmake"
        DESTINATION "${package_dir}")
install(FILES LICENSE DESTINATION "${CMAKE_INSTALL_DOCDIR}")
if(TARGET thalweg)
  install(TARGETS thalweg)
endif()
