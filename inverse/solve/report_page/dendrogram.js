"use strict";
// The light tree: leaves side by side, nodes at the height of their children's distance, the cut ringed.

// Of each node: x, the middle of its children's places, and y, the square root of its distance, or of the largest below it.
function placeNodes(tree) {
  const places = new Array(tree.nodes.length);
  let leaf = 0;
  const open = tree.nodes.length > 0 ? [tree.nodes.length - 1] : [];
  while (open.length > 0) {
    const node = open[open.length - 1], {left, right, distance} = tree.nodes[node];
    if (left < 0) {
      places[node] = {x: leaf++, y: 0};
      open.pop();
    } else if (!places[left]) {
      open.push(left);
    } else if (!places[right]) {
      open.push(right);
    } else {
      const a = places[left], b = places[right];
      places[node] = {x: (a.x + b.x) / 2, y: Math.max(Math.sqrt(distance || 0), a.y, b.y)};
      open.pop();
    }
  }
  return places;
}

function nodesBelow(tree, tops) {
  const below = new Set(), open = [...tops];
  while (open.length > 0) {
    const node = open.pop(), {left, right} = tree.nodes[node];
    below.add(node);
    if (left >= 0) open.push(left, right);
  }
  return below;
}

// An arch over the children of each node, with a gap after it.
function arches(tree, places, chosen) {
  const points = [];
  tree.nodes.forEach(({left, right}, node) => {
    if (left < 0 || !chosen(node)) return;
    const {y} = places[node], a = places[left], b = places[right];
    points.push(a, {x: a.x, y}, {x: b.x, y}, b, {x: NaN, y: NaN});
  });
  return points;
}

function plotTree(canvas, tree) {
  if (tree.nodes.length === 0) return emptyPlot(canvas, "There are no clusters.");
  const places = placeNodes(tree), below = nodesBelow(tree, tree.cut);
  const leaves = Array.from({length: tree.leaves}, (_, k) => k);
  const arch = (label, color, chosen) => line(label, arches(tree, places, chosen), color,
    {showLine: true, pointRadius: 0, pointHitRadius: 0, borderWidth: 1.5});
  const dots = {clip: false, pointRadius: 4.5, showLine: false};
  const name = (item) => item.datasetIndex === 0 ? `light ${item.dataIndex + 1} of the cut` : `cluster ${item.dataIndex + 1}`;
  return new Chart(canvas, {
    type: "scatter",
    data: {datasets: [
      line("cut", tree.cut.map((node) => places[node]), kText,
        {clip: false, showLine: false, pointRadius: 8, pointBackgroundColor: "transparent", pointBorderWidth: 2}),
      line("clusters", leaves.map((k) => places[k]), kAccent,
        {...dots, pointBackgroundColor: leaves.map((k) => cssOf(clusterColor(k))), pointBorderWidth: 0}),
      arch("below the cut", kAccent, (node) => below.has(node)),
      arch("above the cut", "#6c6a66", (node) => !below.has(node)),
    ]},
    options: {
      layout: {padding: {top: 10}},
      scales: {
        x: {display: false, min: -0.6, max: tree.leaves - 0.4},
        y: {min: 0, ticks: {callback: (value) => significant(value * value, 2)}, title: {display: true, text: "distance"}},
      },
      plugins: {tooltip: {filter: (item) => item.datasetIndex < 2, callbacks: {label: name}}},
    },
  });
}
