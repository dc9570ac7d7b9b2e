/** The layers from the side: a link is pulled to another layer. */

import { same, store } from "./store.js";
import { edit } from "./server.js";
import { scene } from "./scene.js";
import { add, Group } from "./elements.js";
import { toScreen } from "./view.js";
import { useOf } from "./plane.js";

/** Pixels; a finger takes a link from 24 px on. */
const ROW = 20;
let svg, rows, marks, grab = null;

export function mount(element) {
  svg = add(element, "svg", { role: "application", "aria-label": "Layers of the links, seen from the side", id: "layers" });
  [rows, marks] = ["rows", "marks"].map((name) => new Group(svg, { class: name }));
  for (const name of ["drawn", "view", "selected", "instant", "verdict"]) store.on(name, show);
  svg.addEventListener("pointerdown", (event) => {
    const name = event.target.link;
    if (!name) return;
    store.put("selected", { kind: "link", name });
    svg.setPointerCapture(event.pointerId);
    grab = { name, from: event.clientY, start: layerOf(name), to: layerOf(name) };
  });
  svg.addEventListener("pointermove", (event) => {
    if (!grab) return;
    grab.to = grab.start + Math.round((grab.from - event.clientY) / ROW);
    show();
  });
  svg.addEventListener("pointerup", () => {
    const done = grab;
    grab = null;
    if (done && done.to !== done.start) put(done.name, done.to);
    else show();
  });
  svg.addEventListener("pointercancel", () => (grab = null));
  svg.addEventListener("keydown", (event) => {
    const step = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (!step || !event.target.link) return;
    event.preventDefault();
    put(event.target.link, layerOf(event.target.link) + step);
  });
  svg.addEventListener("focusin", (event) => event.target.link && store.put("selected", { kind: "link", name: event.target.link }));
}

const layerOf = (name) => store.state.drawn.links.find((link) => link.name === name).layer ?? 0;
const put = (link, to) => edit([{ op: "layer", link, to }]).catch(show);

/** Rows from the top: {layer, links}; links of a layer that would hide one another have rows of their own. */
function rowsOf(links, layer, extent) {
  const layers = links.map(layer);
  const found = [];
  for (let one = Math.max(0, ...layers) + 1; one >= Math.min(0, ...layers) - 1; one -= 1) {
    const lanes = [[]];
    for (const link of links.filter((other) => layer(other) === one)) {
      const [left, right] = extent(link);
      const lap = (a, b) => (Math.min(a[1] - a[0], b[1] - b[0]) > 60 ? 16 : 0); // a short one must not be hidden
      const free = (lane) => lane.map(extent).every((other) => Math.min(other[1], right) - Math.max(other[0], left) <= lap(other, [left, right]));
      const lane = lanes.find(free) ?? lanes[lanes.push([]) - 1];
      lane.push(link);
    }
    found.push(...lanes.map((lane, k) => ({ layer: one, first: k === 0, links: lane })));
  }
  return found;
}

function show() {
  const now = scene();
  if (!now || !store.state.view) return;
  const links = now.links.filter((link) => link.points.length && !(link.ground && !link.part && link.layer === null));
  const layer = (link) => (grab?.name === link.name ? grab.to : link.layer ?? 0);
  const extent = (link) => {
    const xs = link.points.map((point) => toScreen(now.at.get(`${link.name}.${point.name}`))[0]);
    return [Math.min(...xs) - 7, Math.max(...xs) + 7];
  };
  const all = rowsOf(links, layer, extent);
  svg.setAttribute("height", all.length * ROW + 6);
  const heights = new Map();
  all.forEach((row, k) => {
    const y = 3 + (k + 0.5) * ROW;
    for (const link of row.links) heights.set(link.name, y);
    if (!row.first) return;
    rows.put(row.layer, "line", { x1: 0, x2: "100%", y1: y - ROW / 2, y2: y - ROW / 2 });
    rows.put(`t${row.layer}`, "text", { x: 4, y: y + 3.5 }, k ? String(row.layer) : `layer ${row.layer}`);
  });
  for (const joint of now.joints) {
    const mine = joint.links.map((name) => heights.get(name)).filter(Boolean);
    const x = toScreen(joint.at)[0];
    if (mine.length) marks.put(`pin ${joint.name}`, "line", { class: "pin", x1: x, x2: x, y1: Math.min(...mine) - 8, y2: Math.max(...mine) + 8 });
  }
  for (const link of links) bar(link, extent(link), heights.get(link.name));
  for (const group of [rows, marks]) group.end();
}

function bar(link, [left, right], y) {
  const chosen = same(store.state.selected, { kind: "link", name: link.name });
  const colour = link.ground ? "#e8ecef" : useOf(link).colour;
  const box = marks.put(link.name, "rect", { class: chosen ? "chosen" : "", x: left, width: right - left, y: y - 7, height: 14, rx: 4, fill: colour });
  const text = link.layer === null ? "no layer is stated" : `layer ${link.layer}`;
  const target = marks.put(`hold ${link.name}`, "rect", { class: "hold", x: left, width: right - left, y: y - 12, height: 24, tabindex: 0, role: "button", "aria-label": `Link ${link.name}, ${text}; up and down arrows move it` });
  target.link = box.link = link.name;
  marks.put(`text ${link.name}`, "text", { x: (left + right) / 2, y: y + 4, "text-anchor": "middle" }, link.name);
}
