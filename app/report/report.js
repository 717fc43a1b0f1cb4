// SPDX-License-Identifier: Apache-2.0
// What makes the report of `catoptric compare` move: pictures out of the data block, a slider between any two methods,
// tables sorted at a click, charts (Chart.js). Everything the tables say stands in the page without it.
"use strict";

const report = JSON.parse(document.getElementById("report").textContent);

function element(name, properties = {}, ...children) {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...children);
  return made;
}

/** Every picture is in the page once, in the data block. */
function fillPictures() {
  for (const image of document.querySelectorAll("img[data-picture]")) image.src = report.pictures[image.dataset.picture];
}

/** Two pictures on top of each other, the upper one cut off at a line that follows the mouse or the range input. */
function makeSlider(view) {
  const rows = view.rows;
  const select = (chosen) => {
    const list = element("select");
    rows.forEach((row, i) => list.append(element("option", {value: i, textContent: row.name, selected: i === chosen})));
    return list;
  };
  const left = select(Math.max(rows.length - 2, 0)), right = select(rows.length - 1);
  const below = element("img", {alt: "right", draggable: false}), above = element("img", {alt: "left", draggable: false});
  const line = element("div", {className: "line"});
  const range = element("input", {type: "range", min: 0, max: 100, step: 0.1, value: 50, ariaLabel: "where the line is"});
  const stage = element("div", {className: "stage"}, below, above, line);
  const showPictures = () => {
    above.src = report.pictures[rows[left.value].picture];
    below.src = report.pictures[rows[right.value].picture];
  };
  const moveLine = () => {
    above.style.clipPath = `inset(0 ${100 - range.value}% 0 0)`;
    line.style.left = `${range.value}%`;
  };
  const follow = (event) => {
    if (event.buttons === 0 && event.type !== "pointerdown") return;
    const box = stage.getBoundingClientRect();
    range.value = 100 * (event.clientX - box.left) / box.width;
    moveLine();
  };
  left.onchange = right.onchange = showPictures;
  range.oninput = moveLine;
  stage.onpointerdown = stage.onpointermove = follow;
  showPictures();
  moveLine();
  return element("div", {className: "slider"}, element("div", {className: "controls"}, left, right), stage, range);
}

/** Numbers by size, words by alphabet; "-" (no figure) last; the other way round at the next click. */
function sortAtClick(table) {
  const [head, ...body] = [...table.querySelectorAll("tr")];
  [...head.children].forEach((cell, column) => {
    cell.onclick = () => {
      const descends = cell.ariaSort === "ascending";
      const key = (row) => {
        const text = row.children[column].textContent;
        return text === "-" ? null : isNaN(parseFloat(text)) ? text : parseFloat(text);
      };
      body.sort((rowA, rowB) => {
        const a = key(rowA), b = key(rowB);
        if (a === null || b === null) return (a === null) - (b === null);
        const order = a < b ? -1 : a > b ? 1 : 0;
        return descends ? -order : order;
      });
      for (const other of head.children) other.ariaSort = "none";
      cell.ariaSort = descends ? "descending" : "ascending";
      head.after(...body);
    };
  });
}

const colours = ["#8b949e", "#d29922", "#f0883e", "#58a6ff", "#3fb950", "#bc8cff", "#ff7b72", "#39c5cf", "#db61a2"];

function makeChart(settings) {
  const canvas = element("canvas");
  const box = element("div", {}, canvas);
  // Without animation: a page that is printed or photographed at once has its charts.
  queueMicrotask(() => new Chart(canvas, {
    ...settings, options: {animation: false, maintainAspectRatio: false, ...settings.options}}));
  return box;
}

/** What share of the object pixels is displaced by at most so many pixels. */
function makeDistributionChart(view) {
  const rows = view.rows.filter((row) => row.share_within !== null);
  return makeChart({
    type: "line",
    data: {datasets: rows.map((row, i) => ({
      label: row.name, borderColor: colours[i % colours.length], backgroundColor: colours[i % colours.length],
      pointRadius: 2, borderWidth: 2,
      data: report.distribution_px.map((px, k) => ({x: px, y: 100 * row.share_within[k]}))}))},
    options: {
      scales: {x: {type: "logarithmic", title: {display: true, text: "displacement, px"}},
               y: {min: 0, max: 100, title: {display: true, text: "object pixels within, %"}}},
      plugins: {title: {display: true, text: "distribution of displacements"}}}});
}

/** The mean, since a median of 0 has no place on a logarithmic axis. */
function makeCostChart(view) {
  const rows = view.rows.filter((row) => row.mean_px > 0);
  return makeChart({
    type: "scatter",
    data: {datasets: rows.map((row, i) => ({
      label: row.name, backgroundColor: colours[i % colours.length], pointRadius: 6,
      data: [{x: row.median_ms, y: row.mean_px}]}))},
    options: {
      scales: {x: {type: "linear", beginAtZero: true, title: {display: true, text: "frame, ms"}},
               y: {type: "logarithmic", title: {display: true, text: "mean displacement, px"}}},
      plugins: {title: {display: true, text: "error against time"}}}});
}

/** How a frame grows with the number of its pixels; nothing unless several sizes were asked for. */
function makeResolutionCharts(view) {
  if (view.rows[0].sizes.length < 2) return [];
  return [makeChart({
    type: "line",
    data: {datasets: view.rows.map((row, i) => ({
      label: row.name, borderColor: colours[i % colours.length], backgroundColor: colours[i % colours.length],
      pointRadius: 3, borderWidth: 2,
      data: row.sizes.map((size) => ({x: size.megapixels, y: size.ms})).sort((a, b) => a.x - b.x)}))},
    options: {
      scales: {x: {type: "linear", beginAtZero: true, title: {display: true, text: "megapixels"}},
               y: {type: "linear", beginAtZero: true, title: {display: true, text: "frame, ms"}}},
      plugins: {title: {display: true, text: "time against resolution"}}}})];
}

fillPictures();
document.querySelectorAll("table").forEach(sortAtClick);
report.views.forEach((view, i) => {
  const section = document.querySelector(`section[data-view="${i}"] .moving`);
  section.append(makeSlider(view));
  section.append(element("div", {className: "charts"}, makeDistributionChart(view), makeCostChart(view),
                         ...makeResolutionCharts(view)));
});
document.documentElement.dataset.ready = "yes";
