"use strict";
// Error by number of lights, error by stage, seconds by stage.

function setPlotDefaults() {
  Chart.defaults.color = kQuiet;
  Chart.defaults.borderColor = kLine;
  Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
  Chart.defaults.font.size = 12;
  Chart.defaults.animation = false;
  Chart.defaults.maintainAspectRatio = false;
  Chart.defaults.plugins.legend.display = false;
  Chart.defaults.plugins.tooltip.displayColors = false;
}

// 1, 2 and 5 of every power of ten, as percent.
function percentTick(value) {
  const first = Number(value.toExponential(2).split("e")[0]);
  return [1, 2, 5].includes(first) ? Number((100 * value).toPrecision(3)) + " %" : null;
}

const percentAxis = {
  type: "logarithmic",
  ticks: {callback: percentTick},
  grid: {color: kLine},
};

function emptyPlot(canvas, text) {
  canvas.closest("figure").querySelector("figcaption").textContent = text;
  canvas.parentElement.remove();
}

function line(label, data, color, more) {
  return {label, data, borderColor: color, backgroundColor: color, borderWidth: 2, pointRadius: 4, ...more};
}

// A level across the plot.
function level(label, value, count) {
  return line(label, Array(count).fill(value), kQuiet, {borderDash: [4, 4], borderWidth: 1, pointRadius: 0});
}

function plotErrors(canvas, labels, datasets, xTitle) {
  const title = {display: xTitle !== "", text: xTitle};
  return new Chart(canvas, {
    type: "line",
    data: {labels, datasets},
    options: {
      scales: {x: {title, grid: {display: false}}, y: percentAxis},
      plugins: {
        legend: {display: datasets.length > 1, labels: {boxWidth: 20, boxHeight: 0}},
        tooltip: {callbacks: {label: (item) => `${item.dataset.label}: ${percent(item.parsed.y)}`}},
      },
    },
  });
}

function plotCurve(canvas, curve, result) {
  if (curve.length === 0) return emptyPlot(canvas, "No sets of other sizes were looked for.");
  const chosen = result.lights.length;
  const color = curve.map((set) => (set.light_count === chosen ? "#fff" : kAccent));
  const datasets = [line("error", curve.map((set) => set.relative_l2), kAccent,
    {pointBackgroundColor: color, pointRadius: curve.map((set) => (set.light_count === chosen ? 6 : 4))})];
  if (result.target_noise > 0) datasets.push(level("noise of the target", result.target_noise, curve.length));
  return plotErrors(canvas, curve.map((set) => set.light_count), datasets, "lights");
}

// A point per figure whose name ends in relative_l2.
function errorsOfStages(stages) {
  const points = [];
  for (const stage of stages) {
    for (const [name, value] of Object.entries(stage.figures)) {
      if (!name.endsWith("relative_l2") || !(value > 0)) continue;
      points.push({label: words(`${name.replace(/_?relative_l2$/, "")} ${stage.name}`).trim(), value});
    }
  }
  return points;
}

function plotConvergence(canvas, stages, result) {
  const points = errorsOfStages(stages);
  const datasets = [line("error", points.map((point) => point.value), kAccent, {})];
  if (result.target_noise > 0) datasets.push(level("noise of the target", result.target_noise, points.length));
  return plotErrors(canvas, points.map((point) => point.label), datasets, "");
}

function plotSeconds(canvas, stages, seconds) {
  const bars = {data: seconds, backgroundColor: kAccent, borderRadius: 3, maxBarThickness: 14};
  return new Chart(canvas, {
    type: "bar",
    data: {labels: stages.map((stage) => words(stage.name)), datasets: [bars]},
    options: {
      indexAxis: "y",
      scales: {x: {title: {display: true, text: "seconds"}}, y: {grid: {display: false}, ticks: {autoSkip: false}}},
      plugins: {tooltip: {callbacks: {label: (item) => duration(item.parsed.x)}}},
    },
  });
}
