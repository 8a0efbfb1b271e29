"use strict";
// The 3D view: one canvas, one camera, one pane or three side by side.

const kGap = 2;  // pixels between panes
const kBehind = 0x0f1011, kBetween = 0x2e3033;

class View {
  constructor(canvas, receivers, layers, cameras, lights) {
    this.canvas = canvas;
    this.lights = lights;
    this.cameras = cameras;
    this.renderer = new THREE.WebGLRenderer({canvas, antialias: true});
    this.renderer.autoClear = false;
    this.surface = makeSurface(receivers);
    this.layers = layers;
    this.world = new THREE.Scene();
    this.world.add(this.surface, ...layers.map((layer) => layer.object));
    this.box = new THREE.Box3(new THREE.Vector3(...receivers.min), new THREE.Vector3(...receivers.max));
    const size = this.box.getSize(new THREE.Vector3()).length();
    this.camera = new THREE.PerspectiveCamera(kOverviewField, 1, size / 1000, size * 20);
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.enableKeys = false;
    this.controls.screenSpacePanning = true;
    this.controls.addEventListener("change", () => this.redraw());
    this.kinds = [1];
    this.fitted = true;
    this.showLabels();
    this.measure();
    new ResizeObserver(() => this.resized()).observe(canvas.parentElement);
  }

  // At most once per frame of the screen.
  redraw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => { this.waiting = false; this.draw(); });
  }

  measure() {
    const {clientWidth, clientHeight} = this.canvas.parentElement;
    this.size = [clientWidth, clientHeight];
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(clientWidth, clientHeight, false);
    for (const {object} of this.layers) {
      if (object.material.uniforms) object.material.uniforms.pixelRatio.value = this.renderer.getPixelRatio();
    }
  }

  resized() {
    const {clientWidth, clientHeight} = this.canvas.parentElement;
    if (this.size[0] === clientWidth && this.size[1] === clientHeight) return;
    this.measure();
    this.arrange();
  }

  // Draws at once: a canvas of another size is blank, and must not be seen so.
  arrange() {
    if (this.fitted) this.overview();
    this.writeCaptions();
    this.draw();
  }

  // Left, bottom, width and height of each pane: beside one another, or on a narrow screen above one another.
  panes() {
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight, count = this.kinds.length;
    const across = Math.ceil((width - kGap * (count - 1)) / count);
    const down = Math.ceil((height - kGap * (count - 1)) / count);
    return this.kinds.map((_, k) => width > height
      ? [k * (across + kGap), 0, across, height]
      : [0, (count - 1 - k) * (down + kGap), width, down]);
  }

  draw() {
    this.renderer.setScissorTest(false);
    this.renderer.setClearColor(kBetween);
    this.renderer.clear();
    this.renderer.setScissorTest(true);
    this.renderer.setClearColor(kBehind);
    this.panes().forEach((pane, k) => this.drawPane(pane, this.kinds[k]));
    this.placeLabels();
  }

  drawPane([left, bottom, width, height], kind) {
    this.surface.material.uniforms.kind.value = kind;
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.renderer.setViewport(left, bottom, width, height);
    this.renderer.setScissor(left, bottom, width, height);
    this.renderer.clear();
    this.renderer.render(this.world, this.camera);
  }

  show(quantity) {
    this.kinds = quantity.kinds || [quantity.kind];
    this.canvas.parentElement.dataset.panes = this.kinds.length;
    this.arrange();
  }

  writeCaptions() {
    const captions = this.panes().map(([left, bottom, , height], k) => {
      const caption = document.createElement("span");
      caption.textContent = kQuantities.find((other) => other.kind === this.kinds[k]).name.replace("…", "Importance:");
      caption.style.left = left + "px";
      caption.style.top = this.canvas.clientHeight - bottom - height + "px";
      return caption;
    });
    document.getElementById("captions").replaceChildren(...captions);
  }

  setExposure(stops) {
    this.surface.material.uniforms.exposure.value = 2 ** stops;
    this.redraw();
  }

  seeThroughBacks(see) {
    this.surface.material.side = see ? THREE.FrontSide : THREE.DoubleSide;
    this.surface.material.needsUpdate = true;
    this.redraw();
  }

  overview() {
    const [, , width, height] = this.panes()[0];
    this.look(fromOutside(this.box, this.cameras, width / height));
    this.fitted = true;
  }

  lookThrough(camera) {
    this.look(throughCamera(camera, this.box));
    this.fitted = false;
  }

  look({position, target, field}) {
    this.camera.position.copy(position);
    this.camera.fov = field;
    this.controls.target.copy(target);
    this.controls.update();
    this.redraw();
  }

  turnAbout(position) {
    this.fitted = false;
    this.controls.target.set(...position);
    this.controls.update();
    this.redraw();
  }

  showLabels() {
    this.labels = this.lights.map((_, k) => {
      const label = document.createElement("span");
      label.textContent = k + 1;
      return label;
    });
    document.getElementById("labels").replaceChildren(...this.labels);
  }

  placeLabels() {
    const shown = this.layers.find((layer) => layer.id === "found").object.visible && this.kinds.length === 1;
    this.labels.forEach((label, k) => {
      const at = new THREE.Vector3(...this.lights[k].position).project(this.camera);
      label.hidden = !shown || Math.abs(at.z) > 1;
      label.style.left = ((at.x + 1) / 2) * this.canvas.clientWidth + "px";
      label.style.top = ((1 - at.y) / 2) * this.canvas.clientHeight + "px";
    });
  }
}
