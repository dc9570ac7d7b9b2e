/** Draws the linkage to scale, with loads, joint forces and how much of its strength each link uses. */

import { same, store } from "./store.js";
import { shownVerdict } from "./verdict.js";
import { beyond, freePoints, poseHandle, radians, scene } from "./scene.js";
import { ofPose, reachOf } from "./motion.js";
import { add, Group, make, perFrame } from "./elements.js";
import { along, place } from "./labels.js";
import { angle, fit, gridStep, minus, number, plus, size, toScreen, turned } from "./view.js";

/** Share of the linkage's size that the largest force's arrow is long, as in the drawings of reports. */
const ARROW = 0.2;
/** Use of strength: what is up to here, how it is named, its colour, and its hatching for who sees no colours. */
export const USES = [
  [0.5, "up to 50 %", "#c3d8cc"], [0.8, "80 %", "#e6d993"], [1, "100 %", "#ebaf63"], [Infinity, "may be more", "#d9b8d0"], [NaN, "is more", "#e08a80"],
];
let svg, groups, perNewton = 0, hovered = null;

export function mount(element) {
  const hatch = make("pattern", { id: "hatch", width: 6, height: 6, patternUnits: "userSpaceOnUse", patternTransform: "rotate(45)" },
    make("rect", { width: 6, height: 6, fill: USES.at(-1)[2] }), make("line", { x1: 0, y1: 0, x2: 0, y2: 6, stroke: "#b3261e", "stroke-width": 2 }));
  svg = add(element, "svg", { role: "application", "aria-label": "The linkage, to scale", id: "sheet", tabindex: 0 }, make("defs", {}, hatch));
  const names = ["grid", "paths", "links", "springs", "joints", "forces", "texts", "bodies", "handles", "hand"];
  groups = Object.fromEntries(names.map((name) => [name, new Group(svg, { class: name })]));
  for (const name of ["document", "drawn", "verdict", "motion", "instant", "selected", "loadCase", "view", "held", "tool", "ends", "cursor", "paths"]) {
    store.on(name, later);
  }
  svg.addEventListener("pointerover", (event) => hover(event.target.handle ?? null));
  svg.addEventListener("pointerleave", () => hover(null));
  new ResizeObserver(() => (store.state.fitted ? later() : fitAll())).observe(element);
  store.on("drawn", (drawn) => drawn && fitNew());
  return svg;
}

function hover(handle) {
  if (same(hovered, handle)) return;
  hovered = handle;
  later();
}

const later = perFrame(drawAll);

/** Show all of the linkage, with the tips of its arrows. */
export function fitAll() {
  const { width, height } = svg.getBoundingClientRect();
  const now = scene();
  if (!width) return;
  if (!now?.at.size) return void store.put("view", { scale: 4, left: width / 4, top: height / 2 });
  perNewton = arrowScale(now);
  const tips = [...now.loads.flatMap((load) => [...(load.line ?? []), load.at, plus(load.at, load.vector, perNewton)]), ...forcesOf(now).map((one) => plus(one.at, one.force, perNewton))];
  const rings = now.links.flatMap((link) => (link.ground ? [] : link.rings?.[0] ?? []));
  const paths = store.state.paths && store.state.motion?.points ? Object.values(store.state.motion.points).flat() : [];
  const places = [...now.at.values()];
  const room = now.drawn.problem ? [0.5, -0.3].map((share) => plus(places[0], [0, share * now.drawn.size])) : []; // for what is drawn next
  store.put("fitted", true);
  fit([...places, ...room, ...tips, ...rings, ...paths], width, height);
}

let outlined = new Map(); // link that was drawn before -> whether it had an outline

/** Show all at first, and where a link that is new, or has an outline now, lies beyond the sheet. */
function fitNew() {
  const { links } = scene();
  const { width, height } = svg.getBoundingClientRect();
  const fresh = links.filter((link) => !outlined.has(link.name) || (link.rings && !outlined.get(link.name)));
  outlined = new Map(links.map((link) => [link.name, Boolean(link.rings || outlined.get(link.name))]));
  const outside = (place) => toScreen(place).some((one, k) => one < 0 || one > [width, height][k]);
  if (!store.state.fitted || fresh.some((link) => [...link.pieces.flat(), ...(link.rings?.[0] ?? [])].some(outside))) fitAll();
}

/** mm of arrow for a newton; it stays as long as the largest arrow is neither tiny nor huge, so that tips stay where they are. */
function arrowScale(now) {
  const largest = Math.max(0, ...now.loads.map((load) => size(load.vector)), ...forcesOf(now).map((one) => size(one.force)));
  const share = (largest * perNewton) / now.drawn.size;
  if (!largest || (perNewton && store.state.held) || (share > 0.1 && share < 0.4)) return perNewton;
  return (ARROW * now.drawn.size) / largest;
}

export const arrowLength = () => perNewton;

/** Joint forces that are not nil, and where they act. */
function forcesOf(now) {
  const found = now.joints.filter((joint) => now.forces.joints[joint.name]).map((joint) => ({ ...now.forces.joints[joint.name], name: joint.name, at: joint.at }));
  const largest = Math.max(0, ...found.map((one) => one.magnitude));
  return found.filter((one) => one.magnitude > 1e-9 * largest);
}

/** The use of a link's strength, in words and as a colour; where its band goes beyond the limit, it is told whole. */
export function useOf(link) {
  const { use = null, verdict } = shownVerdict(store.state.verdict)?.links?.[link.name] ?? {};
  if (use === null || link.ground || store.state.instant !== null || store.state.drawn.problem) return { text: "", colour: "#9fb1c1", over: false };
  const [least, most] = use.map((share) => number(100 * share, 2));
  const sign = verdict === "fail" ? " ✗" : verdict === "undecided" ? " ?" : "";
  const over = use[0] > 1 && verdict !== "undecided";
  if (use[1] === null) return { text: `${least} % (no band)${sign}`, colour: USES.at(over ? -1 : -2)[2], over };
  const text = use[1] <= 1 || least === most ? most : use[0] > 0 ? `${least} to ${most}` : `up to ${most}`;
  return { text: `${text} %${sign}`, colour: (over ? USES.at(-1) : USES.find(([end]) => use[1] <= end))[2], over };
}

function drawAll() {
  const { state } = store;
  const now = scene();
  svg.classList.toggle("old", Boolean(state.document?.problem) && state.drawn?.revision !== state.document.revision);
  svg.classList.toggle("late", shownVerdict(state.verdict)?.revision < state.document?.revision);
  svg.classList.toggle("sketch", Boolean(state.drawn?.problem));
  svg.dataset.tool = state.tool;
  if (now && state.view) {
    perNewton = arrowScale(now);
    const sheet = { now, texts: [], taken: [], ...svg.getBoundingClientRect().toJSON(), size: now.drawn.size * state.view.scale };
    for (const part of [grid, paths, reach, bodies, springs, joints, forces, moments, handles, lengths, hand, texts]) part(sheet);
  }
  for (const group of Object.values(groups)) group.end();
  legend(now);
}

function grid({ width, height }) {
  const { view } = store.state;
  const step = gridStep();
  const lines = (from, to) => Array.from({ length: Math.max(0, Math.floor(to / step) - Math.ceil(from / step) + 1) }, (_, k) => (Math.ceil(from / step) + k) * step);
  for (const x of lines(-view.left / view.scale, (width - view.left) / view.scale)) {
    const at = toScreen([x, 0])[0];
    groups.grid.put(`x${x}`, "line", { x1: at, x2: at, y1: 0, y2: height });
    if (at > 40 && at < width - 70) groups.grid.put(`tx${x}`, "text", { x: at, y: height - 5, "text-anchor": "middle" }, number(x, 6));
  }
  for (const y of lines((view.top - height) / view.scale, view.top / view.scale)) {
    const at = toScreen([0, y])[1];
    groups.grid.put(`y${y}`, "line", { x1: 0, x2: width, y1: at, y2: at });
    if (at > 16 && at < height - 24) groups.grid.put(`ty${y}`, "text", { x: 4, y: at - 3 }, number(y, 6));
  }
  groups.grid.put("unit", "text", { x: width - 6, y: height - 5, "text-anchor": "end" }, "x, y [mm]");
}

const trace = (points, closed) => points.map((one, k) => `${k ? "L" : "M"}${toScreen(one).map((part) => part.toFixed(1))}`).join("") + (closed ? "Z" : "");

/** Paths of all points over the motion. */
function paths({ now }) {
  const { motion } = store.state;
  if (!store.state.paths || !motion?.points) return;
  for (const [name, points] of Object.entries(motion.points)) {
    if (now.links.some((link) => link.ground && link.points.some((point) => name === `${link.name}.${point.name}`))) continue;
    groups.paths.put(name, "path", { d: trace(points, false) });
  }
}

/** How far the pose's handle gets, with the ends and dead points of its way. */
function reach({ now, texts, taken }) {
  const pose = poseHandle(now, 1 / store.state.view.scale);
  const { ends, dead, turns } = reachOf(store.state.motion) ?? {};
  if (!pose || !ends) return;
  const { kind, value } = now.drawn.coordinate;
  const here = now.still ? value : ofPose(store.state.motion)[store.state.instant];
  const stand = (to) => (pose.way ? plus(pose.at, pose.way, to - here) : plus(pose.pivot, turned(minus(pose.at, pose.pivot), radians(to - here))));
  const way = Array.from({ length: 73 }, (_, k) => stand(ends[0] + ((ends[1] - ends[0]) * k) / 72));
  groups.paths.put("reach", "path", { class: "reach", d: trace(way, false) });
  const open = turns ? [] : ends.filter((end) => !dead.some((one) => Math.abs(one - end) < 0.02 * (ends[1] - ends[0])));
  for (const to of [...dead, ...open]) {
    const [key, at, stops] = [`reach ${to}`, toScreen(stand(to)), dead.includes(to)];
    groups.paths.put(key, "path", { class: stops ? "dead" : "end", d: `M${at[0] - 5} ${at[1]}l5 -5l5 5l-5 5Z` });
    taken.push(at);
    texts.push({ key, text: `${stops ? "dead at " : ""}${number(to)}${kind === "travel" ? " mm" : "°"}`, anchors: [at], kind: "reach", rank: 8 });
  }
}

function bodies(sheet) {
  const { now, taken, texts } = sheet;
  const layers = now.links.filter((link) => !link.ground).map((link) => link.z ?? link.layer ?? 0);
  const [low, high] = [Math.min(...layers), Math.max(...layers)];
  for (const link of [...now.links].sort((a, b) => (a.z ?? a.layer ?? 0) - (b.z ?? b.layer ?? 0))) {
    const handle = { kind: "link", name: link.name };
    const lines = link.pieces.map((piece) => trace(piece, false)).join("");
    const wide = Math.max(link.width * store.state.view.scale, 3);
    if (!link.ground || link.part) taken.push(...link.pieces.flatMap((piece) => seen(piece.map((one) => toScreen(one)), wide / 2)));
    const use = useOf(link);
    const depth = high > low && !link.ground ? ((link.z ?? link.layer ?? 0) - low) / (high - low) : 1;
    const chosen = same(store.state.selected, handle) ? "chosen" : same(hovered, handle) ? "hovered" : "";
    const fill = use.over ? "url(#hatch)" : use.colour;
    if (link.ground && !link.part) {
      groups.links.put(link.name, "path", { d: lines, class: `ground ${chosen}` });
    } else if (link.rings) {
      groups.links.put(`${link.name} part`, "path", { d: link.rings.map((ring) => trace(ring, true)).join(""), class: `part ${chosen} ${use.over ? "over" : ""}`, fill, "fill-rule": "evenodd", "fill-opacity": 0.6 + 0.4 * depth });
    } else {
      groups.links.put(`${link.name} edge`, "path", { d: lines, class: `edge ${chosen} ${use.over ? "over" : ""}`, "stroke-width": wide + 2 });
      groups.links.put(`${link.name} bar`, "path", { d: lines, class: "bar", stroke: use.colour, "stroke-width": wide });
    }
    if (!lines) continue;
    const target = groups.bodies.put(link.name, "path", { d: lines, "stroke-width": Math.max(wide, 24), tabindex: 0, role: "button", "aria-label": said(link, use) });
    target.handle = handle;
    if (link.ground && !link.part) continue;
    const [a, b] = link.pieces.reduce((best, one) => (size(minus(...one)) > size(minus(...best)) ? one : best)).map((one) => toScreen(one));
    const across = angle(minus(b, a)) + Math.PI / 2;
    const anchors = [0.5, 0.35, 0.65, 0.25, 0.75].map((share) => plus(a, minus(b, a), share));
    const text = use.text ? `${link.name}: ${use.text}` : link.name;
    texts.push({ key: `link ${link.name}`, text, anchors, gap: wide / 2 + 4, way: across, kind: `link ${use.over ? "over" : ""}`, rank: 4 });
  }
}

/** Middle and both sides of a bar. */
function seen([a, b], half) {
  const way = angle(minus(b, a));
  const sides = half > 6 ? [-half, 0, half] : [0];
  return sides.flatMap((side) => along(plus(a, turned([0, side], way)), plus(b, turned([0, side], way))));
}

function said(link, use) {
  const ends = link.points.map((point) => point.name).join(", ");
  return `Link ${link.name}${link.ground ? ", ground" : ""}, points ${ends}${use.text ? `, uses ${use.text} of its strength` : ""}`;
}

function springs({ now, texts, taken }) {
  for (const spring of now.springs) {
    const line = spring.line.map((one) => toScreen(one));
    groups.springs.put(spring.name, "path", { d: trace(spring.line, false) });
    line.slice(1).forEach((one, k) => taken.push(...along(line[k], one)));
    texts.push({ key: `spring ${spring.name}`, text: spring.text, anchors: [line[Math.floor(line.length / 2)], line[0], line.at(-1)], kind: "spring", rank: 5 });
  }
}

function joints(sheet) {
  const { now, texts, taken } = sheet;
  const ground = now.links.filter((link) => link.ground).map((link) => link.name);
  for (const joint of now.joints) {
    const [x, y] = toScreen(joint.at);
    const grounded = joint.links.some((name) => ground.includes(name));
    const radius = Math.max(4.5, (joint.diameter * store.state.view.scale) / 2 || 0);
    const cut = joint.kind === "slot" && now.links.some((link) => link.name === joint.links[0] && link.rings); // its outline has the slot
    if (joint.way && !cut) guide(joint, [x, y], grounded, taken);
    else if (grounded && !joint.way) support(joint, [x, y], Math.max(17, radius + 8), sheet);
    const filled = joint.kind === "bonded" || joint.kind === "fixed";
    const handle = { kind: "joint", name: joint.name };
    const shape = { class: `${joint.kind} ${state(handle)}`, fill: filled ? "#1c2733" : "#fff" };
    if (filled) groups.joints.put(joint.name, "rect", { ...shape, x: x - 5, y: y - 5, width: 10, height: 10 });
    else groups.joints.put(joint.name, "circle", { ...shape, cx: x, cy: y, r: Math.min(radius, 14) });
    taken.push([x, y], [x + 5, y], [x - 5, y], [x, y + 5], [x, y - 5]);
    texts.push({ key: `joint ${joint.name}`, text: joint.name, anchors: [[x, y]], gap: 9, kind: "name", rank: 2, needed: true });
  }
  for (const free of freePoints(now)) {
    const [x, y] = toScreen(free.at);
    const handle = { kind: "point", link: free.link, point: free.point };
    groups.joints.put(`${free.link}.${free.point}`, "circle", { class: `point ${state(handle)}`, cx: x, cy: y, r: 3.5, fill: "#1c2733" });
    taken.push([x, y]);
    texts.push({ key: `point ${free.link}.${free.point}`, text: free.point, anchors: [[x, y]], gap: 8, kind: "name", rank: 3 });
  }
}

const state = (handle) => (same(store.state.selected, handle) ? "chosen" : same(hovered, handle) ? "hovered" : same(store.state.ends?.handle, handle) ? "first" : "");

/** Hatched support of the ground, on the side where none of the joint's links is. */
function support(joint, at, deep, { now, taken }) {
  const arms = now.links.filter((link) => joint.links.includes(link.name)).flatMap((link) => link.pieces.flat())
    .map((one) => minus(toScreen(one), at)).filter((arm) => size(arm) > 1).map((arm) => angle(arm));
  const sides = [Math.PI / 2, 0, Math.PI, -Math.PI / 2];
  const worst = (side) => Math.max(-1, ...arms.map((arm) => Math.cos(arm - side)));
  const way = sides.reduce((best, side) => (worst(side) < worst(best) - 1e-6 ? side : best));
  const spot = (far, across) => plus(at, turned([far, across], way));
  const line = (...spots) => spots.map((one, k) => `${k ? "L" : "M"}${one.map((part) => part.toFixed(1))}`).join("");
  const hatching = [-14, -8, -2, 4, 10].map((across) => line(spot(deep, across), spot(deep + 5, across - 4))).join("");
  groups.joints.put(`${joint.name} ground`, "path", { class: "support", d: `${line(at, spot(deep, deep / 2), spot(deep, -deep / 2))}Z${line(spot(deep, 15), spot(deep, -15))}${hatching}` });
  taken.push(...along(at, spot(deep, 9)), ...along(at, spot(deep, -9)), ...along(spot(deep + 2, -17), spot(deep + 2, 15)));
}

/** Both sides of a slot or guide, hatched where the ground has it. */
function guide(joint, at, grounded, taken) {
  const way = angle([joint.way[0], -joint.way[1]]);
  const spot = (far, across) => plus(at, turned([far, across], way));
  const sides = [-11, 11].map((across) => [spot(-46, across), spot(46, across)]);
  const hatching = grounded ? [-40, -30, -20, -10, 0, 10, 20, 30, 40].flatMap((far) => [-1, 1].map((side) => [spot(far, side * 11), spot(far - 4, side * 16)])) : [];
  groups.joints.put(`${joint.name} guide`, "path", { class: "support", d: [...sides, ...hatching].map(([a, b]) => `M${a.map((part) => part.toFixed(1))}L${b.map((part) => part.toFixed(1))}`).join("") });
  for (const [a, b] of sides) taken.push(...along(a, b));
}

function arrow(group, name, from, to, kind) {
  const long = size(minus(to, from));
  if (long < 1) return;
  const way = minus(to, from).map((part) => part / long);
  const head = Math.min(9, long);
  const back = plus(to, way, -head);
  const side = [-way[1] * head * 0.42, way[0] * head * 0.42];
  group.put(`${name} line`, "line", { class: kind, x1: from[0], y1: from[1], x2: back[0], y2: back[1] });
  group.put(`${name} head`, "path", { class: `head ${kind}`, d: `M${to}L${plus(back, side)}L${plus(back, side, -1)}Z` });
}

/** Joint forces and loads as arrows, with their size at the tip. */
function forces({ now, texts, taken }) {
  const arrows = forcesOf(now).map((one) => ({ ...one, key: `force ${one.name}`, kind: "joint-force", rank: 6, text: `${number(one.magnitude)} N`, tip: plus(one.at, one.force, perNewton) }));
  for (const [k, load] of now.loads.entries()) {
    for (const part of ["line", "lever"]) if (load[part]) groups.forces.put(`load ${k} ${part}`, "path", { class: `load ${part}`, d: trace(load[part], false) });
    const newtons = size(load.vector);
    if (!newtons) continue;
    const editable = load.kind === "force";
    const text = editable ? `${number(newtons)} N` : `${number(load.newtons ?? newtons)} N ${load.kind}`;
    arrows.push({ key: `load ${k} ${load.path.join(".")}`, at: load.at, tip: plus(load.at, load.vector, perNewton), kind: editable ? "load" : "load other", text, rank: editable ? 1 : 7, needed: editable, near: !editable, path: load.path });
  }
  for (const one of arrows) {
    const [from, to] = [toScreen(one.at), toScreen(one.tip)];
    if (size(minus(to, from)) < 4 && !one.needed) continue;
    arrow(groups.forces, one.key, from, to, `${one.kind} ${one.path ? state({ kind: "load", path: one.path }) : ""}`);
    taken.push(...along(from, to));
    texts.push({ ...one, anchors: [to], way: angle(minus(to, from)), gap: 6 });
  }
}

/** An arc about a place with an arrow at its end, the direct way of a moment: its middle and ends. */
function arc(name, at, middle, moment, radius, kind) {
  const sense = Math.sign(moment);
  const spots = Array.from({ length: 25 }, (_, k) => plus(at, turned([radius, 0], -(middle + sense * (k / 12 - 1) * 1.05))));
  groups.forces.put(`${name} arc`, "path", { class: kind, d: spots.slice(0, -2).map((one, k) => `${k ? "L" : "M"}${one.map((part) => part.toFixed(1))}`).join("") });
  arrow(groups.forces, name, spots.at(-4), spots.at(-1), kind);
  return spots;
}

function moments({ now, texts, taken }) {
  const found = [];
  const { drive } = now.forces;
  const direction = (name) => ((now.links.find((link) => link.name === name)?.direction ?? 0) * Math.PI) / 180;
  const joint = drive && now.joints.find((one) => one.name === drive.joint);
  const little = 1e-6 * now.drawn.size * Math.max(0, ...forcesOf(now).map((one) => one.magnitude));
  if (joint && Math.abs(drive.torque ?? 0) > little) found.push({ name: "drive", at: joint.at, moment: drive.torque, about: direction(drive.link), kind: "torque", radius: 34 });
  if (joint && drive.force && joint.way) {
    const [from, to] = [toScreen(joint.at), toScreen(plus(joint.at, joint.way, Math.sign(drive.force) * 0.12 * now.drawn.size))];
    arrow(groups.forces, "drive", from, to, "torque");
    texts.push({ key: "drive", text: `drive ${number(Math.abs(drive.force))} N`, anchors: [to], way: angle(minus(to, from)), kind: "torque", rank: 1, needed: true });
  }
  for (const load of now.loads) if (load.moment) found.push({ name: `moment ${load.path.join(".")}`, at: load.at, moment: load.moment, about: direction(load.link), kind: "load", radius: 26 });
  for (const one of found) {
    const spots = arc(one.name, toScreen(one.at), one.about, one.moment, one.radius, one.kind);
    taken.push(...spots);
    texts.push({ key: one.name, text: `${one.name === "drive" ? "drive " : ""}${number(Math.abs(one.moment))} N·mm`, anchors: [spots[12], spots.at(-1), spots[0]], kind: one.kind, rank: 1, needed: true });
  }
}

/** What a hand, a finger or the keyboard takes hold of: at least 24 px wide. */
function handles({ now, taken, texts }) {
  const put = (key, handle, [x, y], label) => {
    const target = groups.handles.put(key, "circle", { cx: x, cy: y, r: 14, tabindex: 0, role: "button", "aria-label": label });
    target.handle = handle;
    return target;
  };
  const where = (at) => `at ${number(at[0], 5)}, ${number(at[1], 5)} mm`;
  for (const load of now.loads) {
    if (load.kind !== "force") continue;
    const [name, tip] = [`load ${load.path.join(".")}`, plus(load.at, load.vector, perNewton)];
    const target = put(name, { kind: "load", path: load.path }, toScreen(tip), `Load on ${load.link} at ${load.point}, ${number(load.vector[0])}, ${number(load.vector[1])} N`);
    if (["select", "remove"].includes(store.state.tool)) Object.assign(groups.bodies.put(name, "path", { d: trace([load.at, tip], false), "stroke-width": 20 }), { handle: target.handle, tip: target });
  }
  for (const free of freePoints(now)) put(`point ${free.link}.${free.point}`, { kind: "point", link: free.link, point: free.point }, toScreen(free.at), `Point ${free.point} of ${free.link} ${where(free.at)}`);
  for (const joint of now.joints) put(`joint ${joint.name}`, { kind: "joint", name: joint.name }, toScreen(joint.at), `Joint ${joint.name} of ${joint.links.join(" and ")}, ${joint.kind}, ${where(joint.at)}`);
  const pose = now.still && poseHandle(now, 1 / store.state.view.scale);
  if (pose) {
    const at = toScreen(pose.at);
    const { coordinate } = now.drawn;
    const unit = coordinate.kind === "travel" ? " mm" : "°";
    groups.joints.put("pose", "circle", { class: `pose ${state({ kind: "pose" })}`, cx: at[0], cy: at[1], r: 7 });
    const way = pose.way ? angle([pose.way[0], -pose.way[1]]) : angle(minus(at, toScreen(pose.pivot))) + Math.PI / 2;
    arrow(groups.joints, "pose a", plus(at, turned([8, 0], way)), plus(at, turned([15, 0], way)), "pose");
    arrow(groups.joints, "pose b", plus(at, turned([-8, 0], way)), plus(at, turned([-15, 0], way)), "pose");
    taken.push(...along(plus(at, turned([-15, 0], way)), plus(at, turned([15, 0], way))));
    if (beyond(coordinate)) texts.push({ key: "beyond", text: "beyond the stated motion", anchors: [at], gap: 12, kind: "link over", rank: 0, needed: true });
    put("pose", { kind: "pose" }, at, `Pose: ${coordinate.kind} of ${coordinate.name} ${number(coordinate.value, 5)}${unit}`);
  }
}

/** Lengths beside the links that are chosen or pulled, and the angle of the pose while it turns. */
function lengths({ now, texts }) {
  const { held, selected } = store.state;
  const mine = (link) => held?.points?.some((one) => link.points.some((point) => one === `${link.name}.${point.name}`)) || (selected?.kind === "link" && selected.name === link.name);
  for (const link of now.links.filter((one) => mine(one) && !one.ground)) {
    link.pieces.forEach((piece, k) => {
      const [a, b] = piece.map((one) => toScreen(one));
      const anchors = [0.5, 0.3, 0.7].map((share) => plus(a, minus(b, a), share));
      texts.push({ key: `length ${link.name} ${k}`, text: `${number(size(minus(...piece)), 5)} mm`, anchors, gap: 16, way: angle(minus(b, a)) - Math.PI / 2, kind: "length", rank: 0, needed: true });
    });
  }
  if (held?.text) texts.push({ key: "held", text: held.text, anchors: [toScreen(held.at)], gap: 24, kind: "length", rank: -1, needed: true });
}

/** What a tool is about to make. */
function hand() {
  const { ends, tool, cursor } = store.state;
  if (ends?.to) {
    const [from, to] = [toScreen(ends.at), toScreen(ends.to)];
    groups.hand.put("line", "line", { x1: from[0], y1: from[1], x2: to[0], y2: to[1] });
  } else if (ends) {
    const [x, y] = toScreen(ends.at);
    groups.hand.put("first", "circle", { cx: x, cy: y, r: 10 });
  }
  if (!cursor || !["link", "ground"].includes(tool)) return;
  const [x, y] = toScreen(cursor);
  groups.hand.put("cross", "path", { d: `M${x - 9} ${y}h18M${x} ${y - 9}v18` });
  const target = groups.handles.put("cursor", "circle", { cx: x, cy: y, r: 12, tabindex: 0, role: "button", "aria-label": `Place ${number(cursor[0], 5)}, ${number(cursor[1], 5)} mm; arrows move it, Enter takes it` });
  target.handle = { kind: "cursor" };
}

function texts({ texts: labels, taken, width, height }) {
  const ordered = labels.sort((a, b) => a.rank - b.rank);
  const found = place(ordered, taken, [22, 4, width - 4, height - 20]);
  ordered.forEach((label, k) => {
    if (!found[k]) return;
    const [left, , , bottom] = found[k];
    groups.texts.put(label.key, "text", { class: label.kind, x: (left + 2).toFixed(1), y: (bottom - 3.5).toFixed(1) }, label.text);
  });
}

/** What colours and arrows mean, in words. */
function legend(now) {
  const element = document.getElementById("legend");
  const uses = now && Object.values(shownVerdict(store.state.verdict)?.links ?? {}).some((one) => one.use !== null);
  const entries = [
    ...(uses ? [["", "strength used, at the worst (✗ fails, ? undecided):"], ...USES.map(([, text, colour], k) => [k < USES.length - 1 ? "use" : "use over", text, colour])] : []),
    ...(now && forcesOf(now).length ? [["joint-force", "joint force"]] : []),
    ...(now?.loads.length ? [["load", now.loads.some((load) => load.line) ? "load; dashed: its line, dotted: rigid lever" : "load"]] : []), ...(now?.forces.drive ? [["torque", "drive"]] : []),
    ...(now?.springs.length ? [["spring", "springs, stops"]] : []),
  ];
  const text = JSON.stringify(entries);
  if (element.dataset.shown === text) return;
  element.dataset.shown = text;
  element.replaceChildren();
  for (const [kind, words, colour] of entries) {
    const one = add(element, "span");
    if (kind) add(one, "i", { class: kind }).style.backgroundColor = colour ?? "";
    one.append(words);
  }
}
