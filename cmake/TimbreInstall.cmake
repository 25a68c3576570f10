include(CMakePackageConfigHelpers)

foreach(room analysis index matching datasets)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${room}
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/timbre
    FILES_MATCHING PATTERN "*.h" PATTERN "detail" EXCLUDE)
endforeach()

install(EXPORT timbreTargets NAMESPACE timbre::
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/timbre)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/timbreConfig.cmake.in
  ${PROJECT_BINARY_DIR}/timbreConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/timbre)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/timbreConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/timbreConfig.cmake ${PROJECT_BINARY_DIR}/timbreConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/timbre)
