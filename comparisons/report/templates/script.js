"use strict";

const DATA = JSON.parse(document.getElementById("_data").textContent);
const PAD = { left: 64, right: 14, top: 22, bottom: 40 };
const SEEN = 0.06; // the largest difference that is drawn, over the size of the drawing
const LEAST = 1e-7; // smaller differences, over the size, are round-off of what the page has
const NAMES = 150; // pixels for the names of the lines in a chart of errors
const ROUND_OFF = 1e-16; // smaller errors are drawn as this

function element(parent, name, attributes = {}) {
  const made = document.createElementNS(parent.namespaceURI, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  parent.append(made);
  return made;
}

function write(parent, text, x, y, anchor) {
  if (text) element(parent, "text", { x, y, "text-anchor": anchor }).textContent = text;
}

// Round numbers between two values, at most `wanted` intervals of them.
function ticks(low, high, wanted) {
  const raw = (high - low) / wanted, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((n) => n * power).find((size) => size >= 0.999 * raw);
  const found = [];
  for (let n = Math.ceil(low / step - 1e-9); n * step <= high + 1e-9 * step; n++) found.push(n * step);
  return found;
}

const short = (value) => String(Number(value.toPrecision(6)));
const decade = (value) => `1e${value}`;
const digits = (value) =>
  value == null ? "-" : value !== 0 && Math.abs(value) < 1e-3 ? value.toExponential(4) : value.toPrecision(6);
const rough = (value) => (value == null ? "-" : value.toExponential(1));

// An empty drawing of the box (left, right, bottom, top): grid, numbers, and a plot inside that clips.
function axes(svg, box, height, titles, format) {
  const width = (svg.clientWidth || 640) - PAD.left - PAD.right;
  svg.replaceChildren();
  svg.setAttribute("viewBox", `0 0 ${width + PAD.left + PAD.right} ${height + PAD.top + PAD.bottom}`);
  const x = (value) => (width * (value - box.left)) / (box.right - box.left);
  const y = (value) => (height * (box.top - value)) / (box.top - box.bottom);
  const plot = element(svg, "svg", { x: PAD.left, y: PAD.top, width, height });
  for (const value of ticks(box.left, box.right, Math.max(2, Math.min(8, width / 80)))) {
    element(plot, "line", { class: "grid", x1: x(value), x2: x(value), y1: 0, y2: height });
    write(svg, short(value), PAD.left + x(value), PAD.top + height + 15, "middle");
  }
  const rows = ticks(box.bottom, box.top, Math.max(2, Math.min(8, height / 40)));
  for (const value of rows.filter((one) => format !== decade || Number.isInteger(one))) {
    element(plot, "line", { class: "grid", x1: 0, x2: width, y1: y(value), y2: y(value) });
    write(svg, format(value), PAD.left - 6, PAD.top + y(value) + 4, "end");
  }
  write(svg, titles.x, PAD.left + width, PAD.top + height + 32, "end");
  write(svg, titles.y, PAD.left - 6, PAD.top - 8, "end");
  return { plot, x, y, width, height };
}

const points = (line, at) => line.map(([a, b]) => `${at.x(a).toFixed(2)},${at.y(b).toFixed(2)}`).join(" ");

function stroke(run) {
  return `stroke:${run.colour};stroke-width:${run.width};stroke-dasharray:${run.dash};opacity:${run.width > 4 ? 0.55 : 1}`;
}

// What all shapes, beams, pins and symbols need, with the shape of the drawing: height over width.
function bounds(data) {
  const all = data.runs.flatMap((run) => run.lines.flat(2));
  for (const beam of data.beams) all.push(...beam);
  for (const { path, radius } of data.pins) {
    for (const [a, b] of path) all.push([a - radius, b - radius], [a + radius, b + radius]);
  }
  for (const { lines, at: nodes } of data.symbols) {
    for (const [x, y] of nodes) all.push(...lines.flat().map(([a, b]) => [a + x, b + y]));
  }
  const box = { left: Infinity, right: -Infinity, bottom: Infinity, top: -Infinity };
  for (const [a, b] of all) {
    box.left = Math.min(box.left, a);
    box.right = Math.max(box.right, a);
    box.bottom = Math.min(box.bottom, b);
    box.top = Math.max(box.top, b);
  }
  const rim = 0.04 * Math.max(box.right - box.left, box.top - box.bottom);
  return { left: box.left - rim, right: box.right + rim, bottom: box.bottom - rim, top: box.top + rim };
}

// The box grown to equal scales, and the height that it takes, no more than half of the screen.
function equal(svg, box) {
  const width = (svg.clientWidth || 640) - PAD.left - PAD.right;
  const wide = box.right - box.left, high = box.top - box.bottom;
  const height = Math.min((width * high) / wide, 0.45 * window.innerHeight);
  const grown = Math.max(0, ((width / height) * high - wide) / 2);
  return [{ ...box, left: box.left - grown, right: box.right + grown }, height];
}

function drawShapes(svg, data, wanted, k) {
  const [box, height] = equal(svg, wanted);
  const unit = data.length.unit;
  const at = axes(svg, box, height, { x: `x [${unit}]`, y: `y [${unit}]` }, short);
  for (const beam of data.beams) element(at.plot, "polyline", { class: "rest", points: points(beam, at) });
  for (const pin of data.pins) element(at.plot, "polyline", { class: "path", points: points(pin.path, at) });
  data.runs.forEach((run, number) => {
    for (const line of run.lines[k] ?? []) {
      element(at.plot, "polyline", { class: "run", "data-run": number, style: stroke(run), points: points(line, at) });
    }
  });
  for (const { lines, at: nodes } of data.symbols) {
    const [x, y] = nodes[k];
    for (const line of lines) element(at.plot, "polyline", { class: "symbol", points: points(line.map(([a, b]) => [a + x, b + y]), at) });
  }
  for (const pin of data.pins) {
    const [a, b] = pin.at[k], star = [], round = [];
    for (let n = 0; n < 60; n++) {
      round.push([a + pin.radius * Math.cos((Math.PI * n) / 30), b + pin.radius * Math.sin((Math.PI * n) / 30)]);
    }
    if (pin.radius) element(at.plot, "polygon", { class: "disc", points: points(round, at) });
    for (let n = 0; n < 10; n++) {
      const radius = n % 2 ? 3 : 8, angle = (Math.PI * n) / 5;
      star.push(`${at.x(a) + radius * Math.sin(angle)},${at.y(b) - radius * Math.cos(angle)}`);
    }
    element(at.plot, "polygon", { class: "pin", points: star.join(" ") });
  }
}

// The runs that are shown beside the focus, with their distances from it enlarged; returns by how much.
function drawApart(svg, data, whole, k, hidden) {
  const exact = data.runs.find((run) => run.label === data.focus).lines[k] ?? [];
  const from = (run) => (run.lines[k] ?? []).map((line, b) => line.map(([x, y], n) => [x - exact[b][n][0], y - exact[b][n][1]]));
  const near = data.runs.map((run, n) => (exact.length && run.label !== data.focus && !hidden.has(String(n)) ? from(run) : []));
  const size = Math.max(whole.right - whole.left, whole.top - whole.bottom);
  const most = Math.max(0, ...near.flat(2).map(([x, y]) => Math.hypot(x, y)));
  const raw = (SEEN * size) / most, power = 10 ** Math.floor(Math.log10(raw));
  const factor = most > LEAST * size ? power * [5, 2, 1].find((n) => n * power <= 1.001 * raw) : 0;
  const runs = data.runs.map((run, n) => ({ ...run, lines: { [k]: run.label === data.focus ? exact : near[n].map((line, b) =>
    line.map(([x, y], i) => [exact[b][i][0] + factor * x, exact[b][i][1] + factor * y])) } }));
  const shown = { ...data, symbols: [], runs: factor ? runs : [] };
  drawShapes(svg, shown, bounds({ ...shown, runs: runs.map((run) => ({ lines: [run.lines[k]] })) }), k);
  return factor;
}

// A chart of one quantity, or of its errors in decades; returns what moves its marker to a load parameter.
function drawChart(svg, data, track, kind) {
  const logarithmic = kind === "errors";
  const scaled = (value) => (value == null ? null : logarithmic ? Math.log10(Math.max(value, ROUND_OFF)) : value);
  const series = data.runs.map((run) => (track[kind][run.label] ?? []).map(scaled));
  const known = series.flat().filter((value) => value != null);
  let [bottom, top] = known.length ? [Math.min(...known), Math.max(...known)] : [0, 1];
  const rim = logarithmic ? 0.3 : 0.05 * (top - bottom || 1);
  [bottom, top] = [bottom - rim, top + rim];
  const times = data.across.values, height = Math.min(240, 0.55 * (svg.clientWidth || 640));
  const last = times[times.length - 1];
  const width = (svg.clientWidth || 640) - PAD.left - PAD.right;
  const box = { left: 0, right: logarithmic ? (last * width) / (width - NAMES) : last, bottom, top };
  const at = axes(svg, box, height, { x: data.across.title, y: "" }, logarithmic ? decade : short);
  if (logarithmic) nameLines(at, data, series, last);
  else drawBands(at, data, track);
  series.forEach((values, number) => {
    let d = "";
    values.forEach((value, k) => {
      if (value != null) d += `${k === 0 || values[k - 1] == null ? "M" : "L"}${at.x(times[k]).toFixed(2)},${at.y(value).toFixed(2)}`;
    });
    if (d) element(at.plot, "path", { class: "run", "data-run": number, style: stroke(data.runs[number]), d });
  });
  const cursor = element(at.plot, "line", { class: "cursor", y1: 0, y2: at.height });
  const dots = data.runs.map((run, number) =>
    element(at.plot, "circle", { class: "dot", "data-run": number, r: 4, style: `fill:${run.colour}` }));
  svg.at = (clientX) => {
    const frame = svg.getBoundingClientRect(), scale = (at.width + PAD.left + PAD.right) / frame.width;
    const t = (box.right * ((clientX - frame.left) * scale - PAD.left)) / at.width;
    return times.reduce((best, time, k) => (Math.abs(time - t) < Math.abs(times[best] - t) ? k : best), 0);
  };
  return (k) => {
    cursor.setAttribute("x1", at.x(times[k]));
    cursor.setAttribute("x2", at.x(times[k]));
    dots.forEach((dot, number) => {
      const value = series[number][k];
      dot.setAttribute("visibility", value == null ? "hidden" : "inherit");
      dot.setAttribute("cx", at.x(times[k]));
      if (value != null) dot.setAttribute("cy", at.y(value));
    });
  };
}

// The names of lines behind their ends, without the word that all have, from above, none over another.
function nameLines(at, data, series, last) {
  const ends = series.map((values, number) => [at.y(values.findLast((value) => value != null) ?? NaN), number]);
  let free = 10;
  for (const [y, number] of ends.filter(([y]) => !Number.isNaN(y)).sort(([a], [b]) => a - b)) {
    const place = Math.max(y + 4, free);
    free = place + 12;
    const name = element(at.plot, "text", { class: "name", "data-run": number, x: at.x(last) + 4, y: place });
    name.textContent = data.runs[number].label.replace(/ elements?( a beam)?$/, "");
  }
}

// The area between every run and the reference, which is the run without errors.
function drawBands(at, data, track) {
  const reference = Object.keys(track.values).find((label) => !(label in track.errors));
  if (reference === undefined || !Object.keys(track.errors).length) return;
  const exact = track.values[reference];
  data.runs.forEach((run, number) => {
    const values = run.label === reference ? [] : track.values[run.label] ?? [];
    const ks = values.map((value, k) => (value == null || exact[k] == null ? -1 : k)).filter((k) => k >= 0);
    const edge = [...ks.map((k) => [data.across.values[k], values[k]]), ...ks.reverse().map((k) => [data.across.values[k], exact[k]])];
    if (edge.length) element(at.plot, "polygon", { class: "band", "data-run": number, style: `fill:${run.colour}`, points: points(edge, at) });
  });
}

// A section with a slider: one number of a load parameter for all of its drawings.
function moving(section, data) {
  const find = (selector) => section.querySelector(selector);
  const all = (selector) => [...section.querySelectorAll(selector)];
  const slider = find("input[type=range]"), play = find(".play"), last = data.load_parameter.length - 1;
  const whole = bounds(data), hidden = new Set(data.runs.flatMap((run, n) => (run.shown ? [] : [String(n)])));
  let k = data.start, moves = [], timer = null;

  function hide() {
    for (const one of all("[data-run]")) one.classList.toggle("off", hidden.has(one.dataset.run));
  }

  function show(wanted) {
    k = Math.max(0, Math.min(last, wanted));
    const t = short(data.load_parameter[k]);
    slider.value = k;
    slider.setAttribute("aria-valuetext", `load parameter ${t}`);
    find("output").textContent = `t = ${t}`;
    find(".now").textContent = `Values at load parameter ${t}`;
    drawShapes(find(".shapes"), data, whole, k);
    const factor = drawApart(find(".apart"), data, whole, k, hidden);
    find(".enlarged").textContent = factor ? `Distances from the ${data.focus}, enlarged ${short(factor)} times.`
      : "No other run that is shown differs by as much as can be drawn.";
    for (const move of moves) move(k);
    for (const row of all("tr[data-run]")) {
      const run = data.runs[row.dataset.run];
      for (const cell of row.querySelectorAll("td")) {
        const { track, kind } = cell.dataset;
        cell.textContent = (kind === "errors" ? rough : digits)(data.tracks[track][kind][run.label]?.[k]);
      }
    }
    showFiles();
    hide();
  }

  function showFiles() {
    const place = find(".vtu"), number = String(k + 1).padStart(4, "0");
    const files = Object.entries(data.vtu).filter(([name]) => data.runs.some((run) => run.label === name && k < run.lines.length));
    place.replaceChildren(files.length ? "VTU at this load parameter: " : "");
    files.forEach(([name, pattern], n) => {
      const link = document.createElement("a");
      link.href = pattern.replace("{}", number);
      link.textContent = name;
      place.append(n ? ", " : "", link);
    });
  }

  function layout() {
    moves = all(".chart").map((svg) => drawChart(svg, data, data.tracks[svg.dataset.track], svg.dataset.kind));
    show(k);
  }

  function halt() {
    clearInterval(timer);
    timer = null;
    play.setAttribute("aria-pressed", "false");
    play.textContent = "play";
  }

  slider.addEventListener("input", () => show(Number(slider.value)));
  play.addEventListener("click", () => {
    if (timer !== null) return halt();
    if (k === last) show(0);
    play.setAttribute("aria-pressed", "true");
    play.textContent = "pause";
    timer = setInterval(() => (k < last ? show(k + 1) : halt()), 80);
  });
  for (const box of all(".switch input")) {
    box.addEventListener("change", () => {
      if (box.checked) hidden.delete(box.dataset.switch);
      else hidden.add(box.dataset.switch);
      show(k);
    });
  }
  for (const svg of all(".chart")) {
    svg.addEventListener("pointermove", (event) => {
      if (event.pointerType === "mouse" || event.buttons) show(svg.at(event.clientX));
    });
    svg.addEventListener("pointerdown", (event) => show(svg.at(event.clientX)));
    svg.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, Home: -last, End: last }[event.key];
      if (step === undefined) return;
      event.preventDefault();
      show(k + step);
    });
  }
  for (const folded of [...all("details"), section.closest("details")]) folded?.addEventListener("toggle", layout);
  addEventListener("resize", layout);
  layout();
}

for (const place of document.querySelectorAll("[data-moving]")) {
  const section = place.closest("section");
  moving(section, DATA[section.id]);
}

// A table that is too wide becomes a list: each number behind the name of its column.
const tables = [...document.querySelectorAll(".scroll, .sheet")];
for (const table of tables.flatMap((one) => [...one.querySelectorAll("table")])) {
  const names = [...table.querySelectorAll("thead th")].map((one) => one.textContent);
  for (const row of table.querySelectorAll("tbody tr")) {
    [...row.children].forEach((cell, n) => (cell.dataset.name = names[n] ?? ""));
  }
}
function fit() {
  for (const one of tables) one.classList.remove("stacked");
  for (const one of tables.filter((one) => one.scrollWidth > one.clientWidth + 1)) one.classList.add("stacked");
}
for (const one of document.querySelectorAll("details")) one.addEventListener("toggle", fit);
addEventListener("resize", fit);
fit();

// A print has no switch to open what is folded; what is folded within it is left to the screen.
addEventListener("beforeprint", () => document.querySelectorAll("section > details").forEach((one) => (one.open = true)));
