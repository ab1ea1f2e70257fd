# What `cmake --install` and the packages consist of: components program (with its library), development and doc.
if(NOT TARGET alluvium) # some rooms only
  return()
endif()
include(CMakePackageConfigHelpers)
set(_package ${CMAKE_INSTALL_LIBDIR}/cmake/alluvium)
set(_data ${CMAKE_INSTALL_DATADIR}/alluvium)

install(TARGETS alluvium RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
install(TARGETS alluvium_core EXPORT alluviumTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT program NAMELINK_COMPONENT development)
install(DIRECTORY prm DESTINATION ${_data} COMPONENT program PATTERN deposits EXCLUDE)

install(DIRECTORY include/alluvium DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
set_target_properties(alluvium_core PROPERTIES EXPORT_NAME core)
install(EXPORT alluviumTargets NAMESPACE alluvium:: DESTINATION ${_package} COMPONENT development)
configure_package_config_file(cmake/alluviumConfig.cmake.in ${CMAKE_BINARY_DIR}/cmake/alluviumConfig.cmake
                              INSTALL_DESTINATION ${_package})
# before 1.0 a minor version may change the interface
write_basic_package_version_file(${CMAKE_BINARY_DIR}/cmake/alluviumConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/cmake/alluviumConfig.cmake ${CMAKE_BINARY_DIR}/cmake/alluviumConfigVersion.cmake
        DESTINATION ${_package} COMPONENT development)

# found by bash-completion under the program's name
install(FILES contrib/completion/alluvium.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program RENAME alluvium)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program RENAME copyright)
install(FILES README.md CHANGELOG.md LICENSE CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT doc)
install(DIRECTORY doc DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT doc
        PATTERN Doxyfile.in EXCLUDE PATTERN doxygen.cmake EXCLUDE PATTERN __pycache__ EXCLUDE)
