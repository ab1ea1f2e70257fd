# Debian packages: contrib/packages, or `cpack -G DEB` in a build folder. Three of them: the program with its library, what others build
# against it with, and the texts.
if(NOT TARGET alluvium)
  return()
endif()
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON) # tests need not be built

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME alluvium)
set(CPACK_PACKAGE_CONTACT "The Alluvium developers <alluvium@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development doc)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_SECTION science)

# Each Debian has its own deal.II, so a package is for one of them, and says which.
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
if(EXISTS /etc/os-release)
  file(STRINGS /etc/os-release _id REGEX "^(ID|VERSION_ID)=")
  string(REGEX REPLACE ".*ID=\"?([0-9.]+)\"?.*" "\\1" _version "${_id}")
  if("${_id}" MATCHES "ID=debian" AND _version MATCHES "^[0-9.]+$")
    set(CPACK_DEBIAN_PACKAGE_RELEASE "1~deb${_version}")
  endif()
endif()

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME alluvium)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS openmpi-bin) # mpirun
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "alluvium-doc, liballuvium-dev, python3-matplotlib, paraview")
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "grains in a fluid: FEM-DEM for immersed granular flows
 Volume-averaged Navier-Stokes equations by finite elements, grains as rigid discs
 with non-smooth contacts, on meshes from much coarser than a grain to finer than one.
 Scenes to start from are in /usr/share/alluvium/prm.")
file(WRITE ${CMAKE_BINARY_DIR}/cmake/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_CONTROL_EXTRA ${CMAKE_BINARY_DIR}/cmake/triggers)

# What compiles and links with deal.II, besides itself: the linker that Debian 13's names.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME liballuvium-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "alluvium (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}), libdeal.ii-dev, nlohmann-json3-dev, g++, cmake, make")
if("${DEAL_II_LINKER_FLAGS}" MATCHES "fuse-ld=mold")
  string(APPEND CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS ", mold")
endif()
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "headers and CMake package of Alluvium
 For plug-ins of one's own (drag laws, boundary conditions, observers ...) and programs
 that use the library: find_package(alluvium) in CMake.")

set(CPACK_DEBIAN_DOC_PACKAGE_NAME alluvium-doc)
set(CPACK_DEBIAN_DOC_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOC_DESCRIPTION "texts about Alluvium
 Tutorial steps with their scenes and programs, guides, equations and measurements.")
include(CPack)
