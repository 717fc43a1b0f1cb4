// SPDX-License-Identifier: Apache-2.0
#include "catoptric/gl/reset_status.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "catoptric/core/error.h"

namespace catoptric::gl {
namespace {

bool isResetForTests(std::string_view context) {
  const char* folder = std::getenv("CATOPTRIC_FAKE_GL_RESET");
  std::error_code none;
  return folder != nullptr && std::filesystem::remove(std::filesystem::path(folder) / context, none);
}

std::string_view describeCause(unsigned status) {
  if (status == GL_GUILTY_CONTEXT_RESET) return "what it drew was taken for a hang";
  if (status == GL_INNOCENT_CONTEXT_RESET) return "another program was the cause";
  return "the cause is not known";
}

}  // namespace

void throwIfReset(std::string_view context, ResetQuery query) {
  unsigned status = query != nullptr ? query() : unsigned(GL_NO_ERROR);
  if (isResetForTests(context)) status = GL_UNKNOWN_CONTEXT_RESET;
  if (status == GL_NO_ERROR) return;
  throw core::Error("gl.lost",
                    fmt::format("the graphics driver has reset the {}'s OpenGL context: {}", context,
                                describeCause(status)),
                    {}, "try again with a smaller --size, or without a GPU (LIBGL_ALWAYS_SOFTWARE=1)");
}

}  // namespace catoptric::gl
