# The reference: ninja doc, then open doc/html/index.html in the build folder.
find_package(Doxygen QUIET)
if(DOXYGEN_FOUND)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/Doxyfile.in ${CMAKE_BINARY_DIR}/Doxyfile @ONLY)
  add_custom_target(doc COMMAND Doxygen::doxygen ${CMAKE_BINARY_DIR}/Doxyfile VERBATIM)
else()
  add_custom_target(doc COMMAND ${CMAKE_COMMAND} -E echo "The target doc needs doxygen." COMMAND ${CMAKE_COMMAND} -E false)
endif()
