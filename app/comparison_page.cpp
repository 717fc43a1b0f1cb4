// SPDX-License-Identifier: Apache-2.0
#include "comparison_page.h"

#include <fmt/format.h>

namespace catoptric::app {
namespace {

constexpr const char* kHead = R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>catoptric: methods against ray-traced truth</title>
<style>
:root { color-scheme: light dark; --line: #8884; --dim: #777; }
body { font: 15px/1.5 system-ui, sans-serif; max-width: 110rem; margin: 0 auto; padding: 1.5rem; }
h1 { font-size: 1.5rem; margin: 0 0 .3rem; } h2 { font-size: 1.2rem; margin: 2.5rem 0 .3rem; }
p { margin: .4rem 0; max-width: 60rem; } .dim, figcaption { color: var(--dim); }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; margin: .8rem 0; display: block; overflow-x: auto; }
th, td { padding: .2rem .7rem; text-align: right; border-bottom: 1px solid var(--line); white-space: nowrap; }
th:first-child, td:first-child { text-align: left; } th { font-weight: 600; }
tr.truth td { color: var(--dim); }
.row { display: grid; grid-template-columns: repeat(auto-fit, minmax(16rem, 1fr)); gap: .8rem; margin: .6rem 0 1.4rem; }
figure { margin: 0; } img { width: 100%; height: auto; display: block; background: #0003; }
figcaption { font-size: .85rem; padding: .15rem 0; }
h3 { font-size: 1rem; margin: 1.2rem 0 .2rem; }
pre { background: #8881; padding: .6rem .8rem; overflow-x: auto; white-space: pre-wrap; }
.ramp { display: inline-block; width: 1em; height: 1em; vertical-align: -.15em; margin: 0 .2em 0 .8em; }
</style>
</head>
<body>
)";

constexpr const char* kIntroduction =
    R"(<p>Each method draws the same view. The <b>displacement</b> of a mirror
pixel is how far away, in pixels, the ray-traced truth shows the world point that the method shows there; 24 pixels or
more count as lost. <b>Object pixels</b> are those where the method or the truth shows neither the sky nor the shell of
the room: walls flatter every method, so these are the figures that count.</p>
<p>Displacement maps:
<span class="ramp" style="background:#12266e"></span>0 px
<span class="ramp" style="background:#2ea043"></span>1 px
<span class="ramp" style="background:#ebdc3c"></span>2 px
<span class="ramp" style="background:#f08c1e"></span>8 px
<span class="ramp" style="background:#c81010"></span>lost. Differences are shown eight times as strong as they are.
Point at a picture to see the truth in its place.</p>
)";

constexpr const char* kFoot = R"(<script>
for (const image of document.querySelectorAll("img[data-truth]")) {
  const own = image.getAttribute("src");
  image.addEventListener("pointerenter", () => image.setAttribute("src", image.dataset.truth));
  image.addEventListener("pointerleave", () => image.setAttribute("src", own));
}
</script>
</body>
</html>
)";

/// Text for HTML; names in a file may hold anything.
std::string escape(const std::string& text) {
  std::string escaped;
  for (const char c : text) switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  return escaped;
}

/// A file name as an address.
std::string escapeUrl(const std::string& path) {
  std::string url;
  for (const char c : path) {
    const bool isPlain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                         c == '-' || c == '_' || c == '.' || c == '/';
    url += isPlain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return url;
}

std::string makeHtmlTable(const Comparison& comparison) {
  const auto rows = makeRows({comparison});
  std::string html = "<table>\n";
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const bool isTruth = r > 0 && comparison.rows[r - 1].isTruth();
    html += isTruth ? "<tr class=\"truth\">" : "<tr>";
    for (std::size_t i = 1; i < rows[r].size(); ++i)  // the scene's name stands above
      html += fmt::format("<{0}>{1}</{0}>", r == 0 ? "th" : "td", escape(rows[r][i]));
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

std::string makeFigure(const std::string& file, const std::string& caption,
                       const std::string& truthFile = {}) {
  if (file.empty()) return {};
  const std::string swap = truthFile.empty() ? "" : fmt::format(" data-truth=\"{}\"", escapeUrl(truthFile));
  return fmt::format(
      "<figure><a href=\"{0}\"><img loading=\"lazy\" src=\"{0}\" alt=\"{1}\"{2}></a>"
      "<figcaption>{1}</figcaption></figure>\n",
      escapeUrl(file), escape(caption), swap);
}

std::string makeSection(const Comparison& comparison) {
  const std::string truth = comparison.rows.back().files.picture;
  std::string html = fmt::format(
      "<h2>{}</h2>\n<p class=\"dim\">camera \"{}\", {}x{}, {} mirror bounce(s), {} sample(s) "
      "a pixel</p>\n",
      escape(comparison.sceneName), escape(comparison.camera.name), comparison.frame.widthPx,
      comparison.frame.heightPx, comparison.frame.bounces, comparison.frame.samples);
  html += makeHtmlTable(comparison);
  for (const ComparisonRow& row : comparison.rows) {
    if (row.isTruth()) continue;
    html += fmt::format("<h3>{}: {}</h3>\n<div class=\"row\">\n", escape(row.variant.name),
                        escape(row.variant.description));
    html += makeFigure(row.files.picture, row.variant.name, truth);
    html += makeFigure(truth, "ray-traced truth");
    html += makeFigure(row.files.displacement, "displacement");
    html += makeFigure(row.files.difference, "difference x 8");
    html += "</div>\n";
  }
  return html;
}

std::string makeEnvironmentList(const Json& environment) {
  std::string html;
  for (const auto& [key, value] : environment.items())
    html += fmt::format("{}: {}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
  return "<h2>Made by</h2>\n<pre>" + escape(html) + "</pre>\n";
}

}  // namespace

std::string makeComparisonPage(const std::vector<Comparison>& comparisons, const Json& document,
                               const std::string& command) {
  std::string html = kHead;
  html += "<h1>Reflections against ray-traced truth</h1>\n";
  html += kIntroduction;
  html += "<pre>" + escape(command) + "</pre>\n";
  for (const Comparison& comparison : comparisons) html += makeSection(comparison);
  html += makeEnvironmentList(document["environment"]);
  return html + kFoot;
}

}  // namespace catoptric::app
