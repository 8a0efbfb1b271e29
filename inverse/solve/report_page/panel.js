"use strict";
// What the 3D view shows: the controls beside it.

function labelled(type, text) {
  const label = document.createElement("label"), input = document.createElement("input");
  input.type = type;
  label.append(input, text);
  return {label, input};
}

function addQuantities(view) {
  const ramp = document.getElementById("ramp");
  ramp.querySelector("i").style.background = `linear-gradient(90deg, ${kRamp.map(cssOf).join(", ")})`;
  kQuantities.forEach((quantity, index) => {
    const {label, input} = labelled("radio", quantity.name);
    input.name = "quantity";
    label.title = quantity.title || "";
    const choose = () => {
      ramp.hidden = !(quantity.kind >= 3);
      view.show(quantity);
    };
    input.addEventListener("change", choose);
    document.getElementById("quantities").append(label);
    if (index === 1) {
      input.checked = true;
      choose();
    }
  });
}

function addExposure(view, automatic) {
  const slider = document.getElementById("exposure"), text = document.getElementById("exposure-text");
  const set = () => {
    const stops = automatic + Number(slider.value);
    text.textContent = (stops < 0 ? "−" : "+") + Math.abs(stops).toFixed(1) + " EV";
    view.setExposure(stops);
  };
  slider.addEventListener("input", set);
  slider.addEventListener("dblclick", () => { slider.value = 0; set(); });
  set();
}

function addLayers(view) {
  for (const layer of view.layers) {
    const {label, input} = labelled("checkbox", "");
    const sign = document.createElement("i"), count = document.createElement("b");
    sign.style.background = layer.sign;
    count.textContent = layer.id === "intervals" ? "" : layer.count;
    label.append(sign, layer.name, count);
    input.id = "layer-" + layer.id;
    input.checked = layer.object.visible = layer.shown;
    input.addEventListener("change", () => {
      layer.object.visible = input.checked;
      view.redraw();
    });
    document.getElementById("layers").append(label);
  }
}

function addCameras(view, cameras) {
  const select = document.getElementById("camera");
  const names = ["from outside", ...cameras.map((camera, k) => camera.name || "camera " + (k + 1))];
  for (const name of names) select.append(new Option(name));
  select.addEventListener("change", () => {
    if (select.selectedIndex === 0) view.overview();
    else view.lookThrough(cameras[select.selectedIndex - 1]);
  });
}

function makePanel(view, receivers, cameras) {
  addExposure(view, automaticExposure(receivers.target));
  addLayers(view);
  addQuantities(view);
  addCameras(view, cameras);
  const backs = document.getElementById("backs");
  backs.addEventListener("change", () => view.seeThroughBacks(backs.checked));
  document.getElementById("panel").addEventListener("submit", (event) => event.preventDefault());
}
