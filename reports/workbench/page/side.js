/** The layers from the side: a link is pulled to another layer. */

import { same, store } from "./store.js";
import { edit } from "./server.js";
import { scene } from "./scene.js";
import { draw, Group } from "./svg.js";
import { toScreen } from "./view.js";
import { useOf } from "./plane.js";

const ROW = 26;
let svg, rows, marks, grab = null;

export function mount(element) {
  svg = draw(element, "svg", { role: "application", "aria-label": "Layers of the links, seen from the side", id: "layers" });
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

function show() {
  const now = scene();
  if (!now || !store.state.view) return;
  const links = now.links.filter((link) => link.points.length);
  const layer = (link) => (grab?.name === link.name ? grab.to : link.layer ?? 0);
  const layers = links.map(layer);
  const [low, high] = [Math.min(...layers) - 1, Math.max(...layers) + 1];
  const height = (high - low + 1) * ROW * 0.75 + 8;
  if (!grab) svg.setAttribute("height", height);
  const step = (height - 8) / (high - low + 1);
  const y = (one) => 4 + (high - one + 0.5) * step;
  const width = svg.clientWidth;
  for (let one = low; one <= high; one += 1) {
    rows.put(one, "line", { x1: 0, x2: width, y1: y(one), y2: y(one) });
    rows.put(`t${one}`, "text", { x: 4, y: y(one) - 3 }, one === high ? `layer ${one}` : String(one));
  }
  for (const joint of now.joints) {
    const mine = links.filter((link) => joint.links.includes(link.name)).map(layer);
    const x = toScreen(joint.at)[0];
    if (mine.length) marks.put(`pin ${joint.name}`, "line", { class: "pin", x1: x, x2: x, y1: y(Math.max(...mine)) - 7, y2: y(Math.min(...mine)) + 7 });
  }
  for (const link of links) bar(link, now, y(layer(link)));
  rows.end();
  marks.end();
}

function bar(link, now, y) {
  const xs = link.points.map((point) => toScreen(now.at.get(`${link.name}.${point.name}`))[0]);
  const [left, right] = [Math.min(...xs) - 7, Math.max(...xs) + 7];
  const chosen = same(store.state.selected, { kind: "link", name: link.name });
  const colour = link.ground ? "#e8ecef" : useOf(link).colour;
  const box = marks.put(link.name, "rect", { class: chosen ? "chosen" : "", x: left, width: right - left, y: y - 6.5, height: 13, rx: 4, fill: colour });
  const text = link.layer === null ? "no layer is stated" : `layer ${link.layer}`;
  const target = marks.put(`hold ${link.name}`, "rect", { class: "hold", x: left, width: right - left, y: y - 12, height: 24, tabindex: 0, role: "button", "aria-label": `Link ${link.name}, ${text}; up and down arrows move it` });
  target.link = box.link = link.name;
  marks.put(`text ${link.name}`, "text", { x: (left + right) / 2, y: y + 4, "text-anchor": "middle" }, link.name);
}
