// SPDX-License-Identifier: Apache-2.0
#include "comparison_page.h"

#include <fmt/format.h>

#include <string_view>

#include "report_files.h"

namespace catoptric::app {
namespace {

constexpr const char* kHead = R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>catoptric: methods against ray-traced truth</title>
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
A click on a table's heading sorts it; a picture leads to its file beside this page, without the losses of the copy in here.</p>
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

/// Frame times by resolution; empty without --sizes.
std::string makeSizeTable(const Comparison& comparison) {
  if (comparison.rows.empty() || comparison.rows.front().sizes.empty()) return {};
  std::string html = "<table class=\"sizes\">\n<tr><th>frame, ms</th>";
  for (const SizedTimes& sized : comparison.rows.front().sizes)
    html += fmt::format("<th>{}x{}</th>", sized.sizePx.x, sized.sizePx.y);
  html += "</tr>\n";
  for (const ComparisonRow& row : comparison.rows) {
    html +=
        fmt::format("<tr{}><td>{}</td>", row.isTruth() ? " class=\"truth\"" : "", escape(row.variant.name));
    for (const SizedTimes& sized : row.sizes) html += fmt::format("<td>{:.1f}</td>", sized.times.medianMs);
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

std::string makeFigure(const std::string& file, const std::string& caption) {
  if (file.empty()) return {};
  return fmt::format(
      "<figure><a href=\"{0}\"><img data-picture=\"{1}\" "
      "alt=\"{2}\"></a><figcaption>{2}</figcaption></figure>\n",
      escapeUrl(file), escape(file), escape(caption));
}

std::string makeSection(const Comparison& comparison, std::size_t index) {
  const std::string truth = comparison.rows.back().files.picture;
  std::string html = fmt::format(
      "<section data-view=\"{}\">\n<h2>{}</h2>\n<p class=\"dim\">camera \"{}\", {}x{}, {} mirror bounce(s), "
      "{} sample(s) "
      "a pixel</p>\n",
      index, escape(comparison.sceneName), escape(comparison.camera.name), comparison.frame.widthPx,
      comparison.frame.heightPx, comparison.frame.bounces, comparison.frame.samples);
  html += makeHtmlTable(comparison) + makeSizeTable(comparison) + "<div class=\"moving\"></div>\n";
  for (const ComparisonRow& row : comparison.rows) {
    if (row.isTruth()) continue;
    html += fmt::format("<h3>{}: {}</h3>\n<div class=\"row\">\n", escape(row.variant.name),
                        escape(row.variant.description));
    html += makeFigure(row.files.picture, row.variant.name);
    html += makeFigure(truth, "ray-traced truth");
    html += makeFigure(row.files.displacement, "displacement");
    html += makeFigure(row.files.difference, "difference x 8");
    html += "</div>\n";
  }
  return html + "</section>\n";
}

/// What report.js reads.
Json makePageData(const std::vector<Comparison>& comparisons) {
  Json data{
      {"distribution_px", metrics::kDistributionPx}, {"views", Json::array()}, {"pictures", Json::object()}};
  for (const Comparison& comparison : comparisons) {
    Json rows = Json::array();
    for (const ComparisonRow& row : comparison.rows) {
      const metrics::DisplacementStatistics& objects = row.displacement.objectPixels;
      Json sizes = Json::array();
      for (const SizedTimes& sized : row.sizes)
        sizes.push_back(
            {{"megapixels", double(sized.sizePx.x) * sized.sizePx.y / 1e6}, {"ms", sized.times.medianMs}});
      rows.push_back({{"name", row.variant.name},
                      {"sizes", sizes},
                      {"picture", row.files.picture},
                      {"median_ms", row.times.medianMs},
                      {"mean_px", objects.meanPx},
                      {"share_within", objects.pixels > 0 ? Json(objects.shareWithin) : Json(nullptr)}});
      data["pictures"][row.files.picture] = row.embedded.picture;
      if (row.isTruth()) continue;
      data["pictures"][row.files.displacement] = row.embedded.displacement;
      data["pictures"][row.files.difference] = row.embedded.difference;
    }
    data["views"].push_back({{"rows", rows}});
  }
  return data;
}

/// JSON within a script element: nothing in it may end the element.
std::string makeDataBlock(const Json& data) {
  std::string text = serialise(data);
  for (std::size_t at = 0; (at = text.find("</", at)) != std::string::npos; at += 3)
    text.replace(at, 2, "<\\/");
  return "<script type=\"application/json\" id=\"report\">" + text + "</script>\n";
}

void appendElement(std::string& html, std::string_view name, std::string_view content) {
  html.append("<").append(name).append(">\n").append(content).append("</").append(name).append(">\n");
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
  appendElement(html, "style", reportStyle());
  html += "</head>\n<body>\n<h1>Reflections against ray-traced truth</h1>\n";
  html += kIntroduction;
  html += "<pre>" + escape(command) + "</pre>\n";
  for (std::size_t i = 0; i < comparisons.size(); ++i) html += makeSection(comparisons[i], i);
  html += makeEnvironmentList(document["environment"]);
  html += makeDataBlock(makePageData(comparisons));
  appendElement(html, "script", chartLibrary());
  appendElement(html, "script", reportScript());
  return html + "</body>\n</html>\n";
}

}  // namespace catoptric::app
