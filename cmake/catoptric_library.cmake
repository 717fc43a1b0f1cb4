# SPDX-License-Identifier: Apache-2.0
# One folder = one target. catoptric_library(NAME deps...) takes every .cpp of the folder; a folder can include only
# headers of the targets it links, because each target exports its own folder through a forwarding include tree.

# Flags of our own code (not of dependencies).
add_library(catoptric_flags INTERFACE)
target_compile_options(catoptric_flags INTERFACE -Wall -Wextra -Wshadow -Wnon-virtual-dtor)
# x86-64-v2 is what Debian users have at least; FMA contraction is off so that results do not depend on the compiler's
# choice of where to fuse.
target_compile_options(catoptric_flags INTERFACE -ffp-contract=off)
if(CATOPTRIC_SANITIZE)
  target_compile_options(catoptric_flags INTERFACE -fsanitize=${CATOPTRIC_SANITIZE} -fno-omit-frame-pointer
                                                   -fno-sanitize-recover=all)
  # In the tests' own files undefined behaviour is not looked for: GoogleTest's templates would take half as long again.
  target_compile_options(catoptric_flags INTERFACE
                         $<$<BOOL:$<TARGET_PROPERTY:CATOPTRIC_IS_TEST>>:-fno-sanitize=undefined>)
  target_link_options(catoptric_flags INTERFACE -fsanitize=${CATOPTRIC_SANITIZE})
endif()

function(catoptric_library NAME)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${NAME}/*.cpp
       ${CMAKE_CURRENT_SOURCE_DIR}/${NAME}/*.h)
  if(NOT sources MATCHES "\\.cpp")  # a folder of headers only still is one target
    file(WRITE ${CMAKE_BINARY_DIR}/${NAME}_empty.cpp "")
    list(APPEND sources ${CMAKE_BINARY_DIR}/${NAME}_empty.cpp)
  endif()
  add_library(catoptric_${NAME} STATIC ${sources})
  set_target_properties(catoptric_${NAME} PROPERTIES LINKER_LANGUAGE CXX POSITION_INDEPENDENT_CODE ON)
  # The folder is visible as "catoptric/NAME/..." through a link of its own, so that an include of a folder that is
  # not a dependency does not compile.
  set(view ${CMAKE_BINARY_DIR}/include/${NAME}/catoptric)
  file(MAKE_DIRECTORY ${view})
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR}/${NAME} ${view}/${NAME} SYMBOLIC)
  target_include_directories(catoptric_${NAME} PUBLIC ${CMAKE_BINARY_DIR}/include/${NAME})
  target_link_libraries(catoptric_${NAME} PUBLIC catoptric_flags ${ARGN})
  set_property(GLOBAL APPEND PROPERTY CATOPTRIC_FOLDERS ${NAME})
endfunction()
