"use strict";
// Numbers as text, and linear colours as the screen's.

const kAccent = "#e9b872", kText = "#e7e4dd", kQuiet = "#9c9a94", kLine = "#2e3033";

const isNumber = (value) => typeof value === "number" && Number.isFinite(value);

function significant(value, digits) {
  if (!isNumber(value)) return "–";
  if (value < 0) return "−" + significant(-value, digits);
  if (value === 0) return "0";
  const places = digits - 1 - Math.floor(Math.log10(value));
  return places < 0 ? String(Math.round(value)) : value.toFixed(Math.min(places, 8));
}

const fixed = (value, decimals) => value.toFixed(decimals).replace("-", "−");

const percent = (value) => (isNumber(value) ? significant(100 * value, 3) + " %" : "–");

function duration(seconds) {
  if (seconds < 60) return significant(seconds, 2) + " s";
  const whole = Math.round(seconds);
  return Math.floor(whole / 60) + " min " + (whole % 60) + " s";
}

const words = (name) => name.replace(/_/g, " ");

const srgb = (linear) => (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055);

// The hue of an intensity: its brightest channel as 1.
function hueOf(intensity) {
  const most = Math.max(...intensity, 1e-30);
  return intensity.map((channel) => srgb(Math.max(0, channel) / most));
}

const cssOf = (color) => `rgb(${color.map((channel) => Math.round(255 * channel)).join(",")})`;

// Colours far from one another for any number of clusters: the golden angle about the hues.
function clusterColor(index) {
  const color = new THREE.Color().setHSL((0.09 + index * 0.381966) % 1, 0.72, 0.6 + 0.1 * ((index % 3) - 1));
  return [color.r, color.g, color.b];
}

const kRamp = [[0.07, 0.07, 0.1], [0.3, 0.16, 0.45], [0.7, 0.25, 0.45], [0.95, 0.52, 0.33], [0.99, 0.92, 0.7]];
