# SPDX-License-Identifier: Apache-2.0
# Shader files are embedded in the library at build time; #include "lib/x.glsl" is resolved when a program is built.
file(GLOB_RECURSE CATOPTRIC_SHADERS CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/shaders/*.glsl
     ${CMAKE_SOURCE_DIR}/shaders/*.vert ${CMAKE_SOURCE_DIR}/shaders/*.frag)
set(CATOPTRIC_EMBEDDED_SHADERS ${CMAKE_BINARY_DIR}/embedded_shaders.cpp)
add_custom_command(
  OUTPUT ${CATOPTRIC_EMBEDDED_SHADERS}
  COMMAND ${Python3_EXECUTABLE} ${CMAKE_SOURCE_DIR}/scripts/embed_shaders.py ${CMAKE_SOURCE_DIR}/shaders
          ${CATOPTRIC_EMBEDDED_SHADERS}
  DEPENDS ${CATOPTRIC_SHADERS} ${CMAKE_SOURCE_DIR}/scripts/embed_shaders.py
  COMMENT "Embedding shaders")
