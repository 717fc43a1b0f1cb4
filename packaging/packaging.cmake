# SPDX-License-Identifier: Apache-2.0
# What is installed and how it is packed. Three components, one Debian package each:
#   tool     catoptric         the command (stands alone: it carries the library in itself), man page, completions
#   library  libcatoptric0     libcatoptric.so
#   dev      libcatoptric-dev  headers, the shader functions that C++ shares, find_package and pkg-config files
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# libcatoptric.so is made of the objects of all folders and links what they link.
get_property(folders GLOBAL PROPERTY CATOPTRIC_FOLDERS)
set(objects "")
set(third_parties "")
foreach(folder IN LISTS folders)
  list(APPEND objects $<TARGET_OBJECTS:catoptric_${folder}>)
  get_target_property(links catoptric_${folder} LINK_LIBRARIES)
  list(FILTER links EXCLUDE REGEX "^catoptric_")
  list(APPEND third_parties ${links})
endforeach()
list(REMOVE_DUPLICATES third_parties)
add_library(catoptric_shared SHARED ${objects})
target_link_libraries(catoptric_shared PRIVATE catoptric_flags catoptric_glad ${third_parties})
target_compile_features(catoptric_shared INTERFACE cxx_std_20)
target_include_directories(catoptric_shared INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
                                                      $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/catoptric/shaders>)
# The target cannot be called catoptric: the command's file is.
set_target_properties(catoptric_shared PROPERTIES OUTPUT_NAME catoptric EXPORT_NAME catoptric LINKER_LANGUAGE CXX
                                                  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR})
target_link_options(catoptric_shared PRIVATE LINKER:--no-undefined)
if(CATOPTRIC_SANITIZE) # the sanitizers' symbols come from the executable
  set_target_properties(catoptric_shared PROPERTIES EXCLUDE_FROM_ALL ON)
  return()
endif()

# tool; its man page and completions come from docs/command-line.md
set(command_docs ${CMAKE_BINARY_DIR}/packaging/command_docs)
add_custom_command(
  OUTPUT ${command_docs}/catoptric.1
  BYPRODUCTS ${command_docs}/catoptric.bash ${command_docs}/_catoptric ${command_docs}/catoptric.fish
  COMMAND ${Python3_EXECUTABLE} ${CMAKE_SOURCE_DIR}/scripts/command_docs.py ${PROJECT_VERSION} ${command_docs}
  DEPENDS ${CMAKE_SOURCE_DIR}/scripts/command_docs.py ${CMAKE_SOURCE_DIR}/docs/command-line.md
  COMMENT "Making the man page and the shell completions")
add_custom_target(catoptric_command_docs ALL DEPENDS ${command_docs}/catoptric.1)
install(TARGETS catoptric_app RUNTIME COMPONENT tool)
install(FILES ${command_docs}/catoptric.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT tool)
install(FILES ${command_docs}/catoptric.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
        RENAME catoptric COMPONENT tool)
install(FILES ${command_docs}/_catoptric DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT tool)
install(FILES ${command_docs}/catoptric.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
        COMPONENT tool)

# library and dev
install(TARGETS catoptric_shared EXPORT catoptric
        LIBRARY COMPONENT library NAMELINK_COMPONENT dev)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/src/catoptric DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev
        FILES_MATCHING PATTERN "*.h" PATTERN gltf EXCLUDE)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/shaders/lib DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/catoptric/shaders
        COMPONENT dev FILES_MATCHING PATTERN "*.glsl")
set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/catoptric)
install(EXPORT catoptric NAMESPACE catoptric:: FILE catoptric-targets.cmake DESTINATION ${config_folder} COMPONENT dev)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/catoptric-config.cmake.in
                              ${CMAKE_BINARY_DIR}/packaging/catoptric-config.cmake INSTALL_DESTINATION ${config_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/packaging/catoptric-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
# The .pc file finds its prefix from where it lies, so that the tree can be moved.
file(RELATIVE_PATH CATOPTRIC_INCLUDE_FROM_LIB ${CMAKE_INSTALL_FULL_LIBDIR} ${CMAKE_INSTALL_FULL_INCLUDEDIR})
configure_file(${CMAKE_CURRENT_LIST_DIR}/catoptric.pc.in ${CMAKE_BINARY_DIR}/packaging/catoptric.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/packaging/catoptric-config.cmake
              ${CMAKE_BINARY_DIR}/packaging/catoptric-config-version.cmake DESTINATION ${config_folder} COMPONENT dev)
install(FILES ${CMAKE_BINARY_DIR}/packaging/catoptric.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)

# Debian packages: cpack -G DEB in the build folder.
set(CPACK_PACKAGE_NAME catoptric)
set(CPACK_PACKAGE_CONTACT "The Catoptric authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE ${CMAKE_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL tool library dev)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS OFF)
set(CPACK_DEBIAN_TOOL_PACKAGE_NAME catoptric)
set(CPACK_DEBIAN_TOOL_PACKAGE_RECOMMENDS "libgl1-mesa-dri, libglfw3")
set(CPACK_DEBIAN_TOOL_DESCRIPTION "True reflections in curved mirrors with a rasterizer (command)
 Opens a glTF scene, finds the mirrors in it, draws their reflections without ray tracing and
 tells how far each picture is from ray-traced truth, in pixels.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libcatoptric${PROJECT_VERSION_MAJOR})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS libgl1-mesa-dri)
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "True reflections in curved mirrors with a rasterizer (library)
 The shared library behind the command catoptric.")
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libcatoptric-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS
    "libcatoptric${PROJECT_VERSION_MAJOR} (= ${PROJECT_VERSION}), libglm-dev")
set(CPACK_DEBIAN_DEV_DESCRIPTION "True reflections in curved mirrors with a rasterizer (development)
 Headers, find_package(catoptric) and pkg-config files.")
include(CPack)
