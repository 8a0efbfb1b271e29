"use strict";
// The numbers of the report, from the page's JSON and the data URIs in it.

function readReport() {
  return JSON.parse(document.getElementById("data").textContent);
}

function bytesOf(dataUri) {
  const text = atob(dataUri.slice(dataUri.indexOf(",") + 1));
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

const floatsOf = (dataUri) => new Float32Array(bytesOf(dataUri).buffer);
const indicesOf = (dataUri) => new Uint32Array(bytesOf(dataUri).buffer);

function floatOfHalf(bits) {
  const exponent = (bits >> 10) & 31, fraction = bits & 1023, sign = bits >> 15 ? -1 : 1;
  return sign * (exponent === 0 ? fraction * 2 ** -24 : (1 + fraction / 1024) * 2 ** (exponent - 15));
}

function floatsOfHalves(packed) {
  const halves = new Uint16Array(bytesOf(packed.values).buffer);
  const table = Float32Array.from({length: 65536}, (_, bits) => packed.scale * floatOfHalf(bits));
  return Float32Array.from(halves, (bits) => table[bits]);
}

function positionsWithin(dataUri, min, max) {
  const packed = new Uint16Array(bytesOf(dataUri).buffer);
  return Float32Array.from(packed, (value, i) => min[i % 3] + (value / 65535) * (max[i % 3] - min[i % 3]));
}

// Four bytes per receiver: one of each list.
function interleavedBytes(lists) {
  const columns = lists.map((list) => bytesOf(list.values));
  const bytes = new Uint8Array(4 * columns[0].length);
  columns.forEach((column, k) => column.forEach((value, i) => (bytes[4 * i + k] = value)));
  return bytes;
}

function decodeReceivers(packed) {
  return {
    count: packed.count,
    triangleCount: packed.triangle_count,
    min: packed.min,
    max: packed.max,
    positions: positionsWithin(packed.positions, packed.min, packed.max),
    triangles: indicesOf(packed.triangles),
    target: floatsOfHalves(packed.target),
    difference: floatsOfHalves(packed.difference),
    scalars: interleavedBytes([packed.importance, packed.geometry, packed.laplacian, packed.weight]),
    chosen: indicesOf(packed.chosen),
  };
}
