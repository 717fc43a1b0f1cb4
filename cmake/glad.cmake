# SPDX-License-Identifier: Apache-2.0
# OpenGL functions, generated at build time by glad 2 (Debian: python3-glad) from the registry file that ships inside
# that package: --reproducible keeps glad from fetching a newer one over the network.
# What it gives: target catoptric_glad, #include <glad/gl.h>, gladLoadGL(GLADloadfunc).
find_program(GLAD_PROGRAM glad)
if(NOT GLAD_PROGRAM)
  message(FATAL_ERROR "The GL loader generator 'glad' is missing. Install it: apt-get install python3-glad")
endif()

# Core 3.3 is the baseline (docs/decisions.md); each extension here is optional at run time and has a capability check.
set(CATOPTRIC_GL_EXTENSIONS
    GL_KHR_debug # error messages with their cause; every test fails on one
    GL_KHR_robustness # a lost context is told, not guessed
    GL_EXT_texture_filter_anisotropic # two names of one thing: core drivers since 4.6 give the ARB one only
    GL_ARB_texture_filter_anisotropic
    GL_ARB_timer_query
    GL_ARB_clip_control
    GL_ARB_texture_storage)
list(JOIN CATOPTRIC_GL_EXTENSIONS "," glad_extensions)

set(glad_folder ${CMAKE_BINARY_DIR}/glad)
add_custom_command(
  OUTPUT ${glad_folder}/src/gl.c ${glad_folder}/include/glad/gl.h ${glad_folder}/include/KHR/khrplatform.h
  COMMAND ${GLAD_PROGRAM} --quiet --reproducible --api gl:core=3.3 --extensions ${glad_extensions} --out-path
          ${glad_folder} c
  COMMENT "Generating the OpenGL loader"
  VERBATIM)
add_library(catoptric_glad STATIC ${glad_folder}/src/gl.c ${glad_folder}/include/glad/gl.h)
set_target_properties(catoptric_glad PROPERTIES POSITION_INDEPENDENT_CODE ON)
target_include_directories(catoptric_glad SYSTEM PUBLIC ${glad_folder}/include)
