"use strict";
// The page, part by part. What a test looks at stands in the body's data: ready, view, lights, triangles, faults.

const faults = [];
addEventListener("error", (event) => faults.push(event.message));
addEventListener("securitypolicyviolation", (event) => faults.push("asks for " + event.blockedURI));

function makeView(report, receivers) {
  try {
    const canvas = document.getElementById("view");
    const layers = makeLayers(report, receivers);
    return new View(canvas, receivers, layers, report.cameras, report.result.lights);
  } catch (error) {
    for (const id of ["view", "panel"]) document.getElementById(id).hidden = true;
    document.getElementById("no-view").hidden = false;
    console.warn(error);
    return null;
  }
}

function makePlots(report) {
  const canvas = (id) => document.getElementById(id);
  setPlotDefaults();
  plotCurve(canvas("curve"), report.error_curve, report.result);
  plotConvergence(canvas("convergence"), report.stages, report.result);
  plotSeconds(canvas("seconds"), report.stages, report.result.stage_seconds);
  plotTree(canvas("tree"), report.tree);
}

function makePage() {
  const report = readReport(), receivers = decodeReceivers(report.receivers), {result} = report;
  document.title = report.scene + " · chiaro";
  document.getElementById("scene").textContent = report.scene;
  document.getElementById("termination").textContent =
    `Ended: ${result.termination}. ${receivers.count} receivers, ${receivers.triangleCount} triangles.`;
  fillFigures(result);
  fillRemarks(result);
  fillStages(report.stages, result.stage_seconds);
  const view = makeView(report, receivers);
  fillLights(result.lights, (light) => view && view.turnAbout(light.position));
  makePlots(report);
  if (view) makePanel(view, receivers, report.cameras);
  Object.assign(document.body.dataset, {
    view: view ? "yes" : "no",
    lights: document.querySelectorAll("#lights tbody tr").length,
    remarks: document.querySelectorAll("#remarks li").length,
    triangles: view ? view.renderer.info.render.triangles : 0,
  });
}

makePage();
document.body.dataset.faults = faults.join("; ");
document.body.dataset.loads = performance.getEntriesByType("resource").length;
document.body.dataset.ready = "yes";
