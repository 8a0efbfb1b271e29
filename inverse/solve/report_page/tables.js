"use strict";
// The figures of the whole solve, the lights found, and what each stage says.

const kMostPercent = 10;  // times what was wanted: more is not told in percent

function element(tag, text) {
  const made = document.createElement(tag);
  if (text !== undefined) made.textContent = text;
  return made;
}

function fillFigures(result) {
  const figures = [
    ["Error, traced afresh", percent(result.relative_l2)],
    ["Error by the cache", percent(result.relative_l2_cached)],
    ["Before the last optimisation", percent(result.initial_relative_l2)],
    ["Noise of the target", result.target_noise > 0 ? percent(result.target_noise) : "not known"],
    ["Its noise, taken out", isNumber(result.verification_noise) ? percent(result.verification_noise) : "not known"],
    ["Lights", String(result.lights.length)],
    ["Important vertices", String(result.important_vertices)],
    ["Time", duration(result.stage_seconds.reduce((sum, seconds) => sum + seconds, 0))],
  ];
  for (const [name, value] of figures) {
    const entry = element("div");
    entry.append(element("dt", name), element("dd", value));
    document.getElementById("figures").append(entry);
  }
}

// "back wall near 1.2, 0.8, −3 m is 62 % too dark: 41 % of the error"
function textOfPlace(place) {
  const how = place.too_dark ? "dark" : "bright", times = Math.abs(place.relative_excess ?? Infinity);
  const amount = times < kMostPercent ? percent(times) : "far";
  const what = place.other_color ? "has another colour" : `is ${amount} too ${how}`;
  const at = place.position.map((metres) => significant(metres, 3)).join(", ");
  return `Not reached: ${place.node} near ${at} m ${what}, ${percent(place.share_of_error)} of the error.`;
}

// Where the target cannot be produced, what would help, and which lights cannot be told apart.
function fillRemarks(result) {
  const remarks = result.not_reached.map(textOfPlace);
  if (result.advice) remarks.push(`Advice: ${result.advice}.`);
  for (const group of result.not_told_apart) {
    remarks.push(`Of lights ${group.slice(0, -1).join(", ")} and ${group.at(-1)} only the sum is known.`);
  }
  const list = document.getElementById("remarks");
  list.append(...remarks.map((text) => element("li", text)));
  list.hidden = remarks.length === 0;
}

// As many decimals as the surest of the numbers has a use for.
function decimalsFor(halves) {
  const least = Math.min(...halves.filter((half) => isNumber(half) && half > 0));
  return isNumber(least) ? Math.min(4, Math.max(0, -Math.floor(Math.log10(least / 2)))) : 3;
}

function numberCell(label, value, half, decimals) {
  const cell = element("td");
  cell.dataset.label = label;
  cell.append(fixed(value, decimals), element("small", isNumber(half) ? " ± " + fixed(half, decimals) : " ± –"));
  return cell;
}

function lightRow(light, index, decimals, select) {
  const row = element("tr"), name = element("td"), swatch = element("i");
  swatch.style.background = cssOf(hueOf(light.intensity));
  name.append(swatch, `${index + 1}  ${light.name}`);
  row.append(name);
  const {position, intensity} = light.interval_90;
  ["x", "y", "z"].forEach((axis, k) =>
    row.append(numberCell(axis + " (m)", light.position[k], position[k], decimals.metres)));
  ["red", "green", "blue"].forEach((channel, k) =>
    row.append(numberCell(channel + " (cd)", light.intensity[k], intensity[k], decimals.candela)));
  const share = element("td", percent(light.contribution));
  share.dataset.label = "contribution ";
  row.append(share);
  row.tabIndex = 0;
  row.addEventListener("click", () => select(light));
  row.addEventListener("keydown", (event) => { if (event.key === "Enter") select(light); });
  return row;
}

function headRow(names) {
  const head = element("thead"), row = element("tr");
  for (const name of names) row.append(element("th", name));
  head.append(row);
  return head;
}

function fillLights(lights, select) {
  const body = element("tbody"), halves = (what) => lights.flatMap((light) => light.interval_90[what]);
  const decimals = {metres: decimalsFor(halves("position")), candela: decimalsFor(halves("intensity"))};
  lights.forEach((light, k) => body.append(lightRow(light, k, decimals, select)));
  const units = ["x (m)", "y (m)", "z (m)", "red (cd)", "green (cd)", "blue (cd)"];
  document.getElementById("lights").append(headRow(["light", ...units, "contribution"]), body);
}

function fillStages(stages, seconds) {
  const body = element("tbody");
  stages.forEach((stage, k) => {
    const row = element("tr");
    const figures = Object.entries(stage.figures).map(([name, value]) => `${words(name)} ${significant(value, 4)}`);
    row.append(element("td", words(stage.name)), element("td", duration(seconds[k])), element("td", figures.join(" · ")));
    body.append(row);
  });
  document.getElementById("stages").append(headRow(["stage", "time", "figures"]), body);
}
