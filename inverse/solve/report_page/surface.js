"use strict";
// The receivers' triangles, coloured by a quantity that a uniform chooses: changing it or the exposure moves no data.

// kind: 0 target, 1 found, 2 difference x 8; 3 … 6 the channels of the scalars.
const kQuantities = [
  {name: "Target", kind: 0}, {name: "Found", kind: 1}, {name: "Difference × 8", kind: 2},
  {name: "Side by side", kinds: [0, 1, 2]}, {name: "Importance", kind: 3}, {name: "… geometry", kind: 4},
  {name: "… illumination", kind: 5, title: "absolute cotangent Laplacian of the target"}, {name: "Weight", kind: 6},
];

const kSurfaceVertex = `
  attribute vec3 target, difference;
  attribute vec4 scalars;
  uniform float kind;
  varying vec3 light, at;
  varying float scalar;
  void main() {
    light = kind < 0.5 ? target : kind < 1.5 ? max(target + difference, 0.0) : 8.0 * abs(difference);
    scalar = kind < 3.5 ? scalars.x : kind < 4.5 ? scalars.y : kind < 5.5 ? scalars.z : scalars.w;
    vec4 seen = modelViewMatrix * vec4(position, 1.0);
    at = seen.xyz;
    gl_Position = projectionMatrix * seen;
  }`;

const kSurfaceFragment = `
  uniform float kind, exposure;
  uniform vec3 ramp[5];
  varying vec3 light, at;
  varying float scalar;
  vec3 srgb(vec3 v) {
    v = clamp(v, 0.0, 1.0);
    return mix(12.92 * v, 1.055 * pow(v, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, v));
  }
  vec3 ramped(float x) {
    vec3 color = ramp[0];
    for (int k = 1; k < 5; ++k) color = mix(color, ramp[k], clamp(4.0 * x - float(k - 1), 0.0, 1.0));
    return color;
  }
  void main() {
    if (kind < 2.5) {
      gl_FragColor = vec4(srgb(exposure * light), 1.0);
    } else {
      float facing = abs(normalize(cross(dFdx(at), dFdy(at))).z);
      gl_FragColor = vec4(ramped(scalar) * (0.7 + 0.3 * facing), 1.0);
    }
  }`;

function makeSurface(receivers) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(receivers.positions, 3));
  geometry.setAttribute("target", new THREE.BufferAttribute(receivers.target, 3));
  geometry.setAttribute("difference", new THREE.BufferAttribute(receivers.difference, 3));
  geometry.setAttribute("scalars", new THREE.BufferAttribute(receivers.scalars, 4, true));
  geometry.setIndex(new THREE.BufferAttribute(receivers.triangles, 1));
  const material = new THREE.ShaderMaterial({
    uniforms: {kind: {value: 1}, exposure: {value: 1}, ramp: {value: kRamp.map((c) => new THREE.Vector3(...c))}},
    vertexShader: kSurfaceVertex,
    fragmentShader: kSurfaceFragment,
    extensions: {derivatives: true},
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
  });
  return new THREE.Mesh(geometry, material);
}

// Stops that make all but the brightest hundredth of the target fit the screen.
function automaticExposure(target) {
  const step = Math.max(1, Math.floor(target.length / 300000)), values = [];
  for (let i = 0; i < target.length; i += step) if (target[i] > 0) values.push(target[i]);
  values.sort((a, b) => a - b);
  return values.length > 0 ? -Math.log2(values[Math.floor(0.99 * (values.length - 1))]) : 0;
}
