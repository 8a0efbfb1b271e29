"use strict";
// What can be shown besides the surfaces, stage by stage of the solve.

function triples(flat) {
  return Array.from({length: flat.length / 3}, (_, i) => Array.from(flat.subarray(3 * i, 3 * i + 3)));
}

// Sizes of lights from `least` to `most` pixels, by the square root of their brightest channel.
function sizesOf(lights, least, most) {
  const bright = lights.map((light) => Math.max(...light.intensity));
  const brightest = Math.max(...bright, 1e-30);
  return bright.map((value) => least + (most - least) * Math.sqrt(value / brightest));
}

function markersOfLights(lights, look) {
  return makeMarkers({
    positions: lights.map((light) => light.position),
    colors: lights.map((light, k) => (look.color ? look.color(k) : hueOf(light.intensity))),
    sizes: sizesOf(lights, ...look.pixels),
    shape: look.shape,
    inFront: look.inFront,
  });
}

function markersAt(positions, color, pixels) {
  return makeMarkers({
    positions,
    colors: positions.map(() => color),
    sizes: positions.map(() => pixels),
    shape: "dot",
    inFront: false,
  });
}

function chosenPositions(receivers) {
  return Array.from(receivers.chosen, (i) => Array.from(receivers.positions.subarray(3 * i, 3 * i + 3)));
}

// Of each: name, count, object, whether it is shown at first, and the colour of its sign.
function makeLayers(report, receivers) {
  const grid = triples(floatsOf(report.grid)), chosen = chosenPositions(receivers);
  const cut = report.tree.cut.map((node) => report.tree.representatives[node]);
  const {coarse, fine, clusters, result: {lights}} = report;
  const layer = (id, name, count, object, shown, sign) => ({id, name, count, object, shown, sign});
  return [
    layer("chosen", "Chosen vertices", chosen.length, markersAt(chosen, [0.45, 0.85, 0.75], 5), false, "#73d9bf"),
    layer("grid", "Light grid", grid.length, markersAt(grid, [0.62, 0.66, 0.72], 4), false, "#9ea8b8"),
    layer("coarse", "After coarse NNLS", coarse.length,
      markersOfLights(coarse, {shape: "disc", pixels: [5, 14]}), false, "#b9b2a6"),
    layer("fine", "After fine NNLS", fine.length,
      markersOfLights(fine, {shape: "disc", pixels: [5, 14]}), false, "#d8d2c6"),
    layer("clusters", "Clusters", clusters.length,
      markersOfLights(clusters, {shape: "disc", pixels: [16, 28], color: clusterColor, inFront: true}), false,
      "conic-gradient(#e96, #ec6, #7c8, #6ad, #b8d, #e96)"),
    layer("cut", "Cut of the light tree", cut.length,
      markersOfLights(cut, {shape: "ring", pixels: [28, 40], inFront: true}), false, "radial-gradient(#1e1f21 40%, #e7e4dd 45%)"),
    layer("found", "Lights found", lights.length,
      markersOfLights(lights, {shape: "glow", pixels: [36, 64], inFront: true}), true, "radial-gradient(#fff 35%, #e9b872 70%)"),
    layer("intervals", "… their 90 % intervals", lights.length, makeIntervals(lights), true, "#fff"),
  ];
}
