"use strict";
// Discs, rings and glows of so many pixels at points in space.

const kMarkerVertex = `
  attribute vec3 tint;
  attribute float size;
  uniform float pixelRatio;
  varying vec3 color;
  void main() {
    color = tint;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
    gl_PointSize = size * pixelRatio;
  }`;

const kMarkerFragments = {
  disc: `
    float edge = 1.0 - smoothstep(0.8, 1.0, r);
    gl_FragColor = vec4(color * (1.0 - 0.6 * smoothstep(0.6, 0.8, r)), edge);`,
  dot: `
    gl_FragColor = vec4(color, 0.55 * (1.0 - smoothstep(0.6, 1.0, r)));`,
  ring: `
    float edge = smoothstep(0.55, 0.65, r) * (1.0 - smoothstep(0.9, 1.0, r));
    float shade = smoothstep(0.62, 0.7, r) * (1.0 - smoothstep(0.82, 0.9, r));
    gl_FragColor = vec4(color * shade, edge);`,
  glow: `
    float core = 1.0 - smoothstep(0.19, 0.24, r), rim = 1.0 - smoothstep(0.26, 0.31, r);
    float halo = 0.4 * pow(1.0 - min(r, 1.0), 2.0);
    gl_FragColor = vec4(mix(color, mix(vec3(0.0), mix(color, vec3(1.0), 0.5), core), rim), max(rim, halo));`,
};

function markerMaterial(shape, inFront) {
  return new THREE.ShaderMaterial({
    uniforms: {pixelRatio: {value: 1}},
    vertexShader: kMarkerVertex,
    fragmentShader: `varying vec3 color;
      void main() {
        float r = 2.0 * length(gl_PointCoord - 0.5);
        if (r > 1.0) discard;
        ${kMarkerFragments[shape]}
      }`,
    transparent: true,
    depthWrite: false,
    depthTest: !inFront,
  });
}

// positions: [x, y, z] each, metres; colors: [r, g, b] each, of the screen; sizes: diameters, pixels.
function makeMarkers({positions, colors, sizes, shape, inFront}) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(positions.flat()), 3));
  geometry.setAttribute("tint", new THREE.BufferAttribute(Float32Array.from(colors.flat()), 3));
  geometry.setAttribute("size", new THREE.BufferAttribute(Float32Array.from(sizes), 1));
  const points = new THREE.Points(geometry, markerMaterial(shape, inFront));
  points.frustumCulled = false;
  points.renderOrder = inFront ? 2 : 1;
  return points;
}

// A cross of each light's intervals.
function makeIntervals(lights) {
  const ends = [];
  for (const {position, interval_90: {position: half}} of lights) {
    for (let axis = 0; axis < 3; ++axis) {
      if (!isNumber(half[axis])) continue;
      for (const sign of [-1, 1]) ends.push(...position.map((p, k) => p + (k === axis ? sign * half[k] : 0)));
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(ends), 3));
  const material = new THREE.LineBasicMaterial({color: 0xffffff, depthTest: false, transparent: true, opacity: 0.85});
  const lines = new THREE.LineSegments(geometry, material);
  lines.frustumCulled = false;
  lines.renderOrder = 3;
  return lines;
}
