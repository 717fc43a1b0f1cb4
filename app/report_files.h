// SPDX-License-Identifier: Apache-2.0
// The files that the report of compare carries in itself (scripts/embed_text.py).
#pragma once

#include <string_view>

namespace catoptric::app {

[[nodiscard]] std::string_view reportStyle();   ///< app/report/report.css
[[nodiscard]] std::string_view reportScript();  ///< app/report/report.js
[[nodiscard]] std::string_view chartLibrary();  ///< Chart.js, as Debian ships it

}  // namespace catoptric::app
