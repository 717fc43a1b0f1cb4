// SPDX-License-Identifier: Apache-2.0
// The viewer's sessions as JSON files. Scene and surroundings are written relative to the file's folder, so
// that both can move together.
#pragma once

#include <string>

#include "viewer/session.h"

namespace catoptric::app {

/// Whole or not at all. Throws core::Error("file.write").
void writeSession(const std::string& file, const viewer::Session& session);

/// Throws core::Error("file.*") or core::Error("session.invalid"), which says where in the file.
[[nodiscard]] viewer::Session readSession(const std::string& file);

}  // namespace catoptric::app
