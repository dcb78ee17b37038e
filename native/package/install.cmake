# SPDX-License-Identifier: LGPL-2.1-or-later
# What is installed where, and the Debian package.
include(CMakePackageConfigHelpers)
set(SWARF_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/swarf)

install(TARGETS swarf EXPORT swarfTargets)
install(DIRECTORY native/include/swarf DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT swarfTargets NAMESPACE swarf:: DESTINATION ${SWARF_CMAKE_DIR})
configure_package_config_file(native/package/swarfConfig.cmake.in swarfConfig.cmake INSTALL_DESTINATION ${SWARF_CMAKE_DIR})
write_basic_package_version_file(swarfConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/swarfConfig.cmake ${PROJECT_BINARY_DIR}/swarfConfigVersion.cmake
  DESTINATION ${SWARF_CMAKE_DIR})

# The .pc file finds its prefix from its own place, so that the installed tree can be moved.
file(RELATIVE_PATH SWARF_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" SWARF_PC_PREFIX ${SWARF_PC_PREFIX})
configure_file(native/package/swarf.pc.in swarf.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/swarf.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The Swarf developers <swarf@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "python3 (>= 3.11)")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS freecad)
include(CPack)
