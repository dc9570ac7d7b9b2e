/** What hands do in the plane: mouse, touch, pen and keyboard. */

import { store, same } from "./store.js";
import { change, edit, newGesture, tell } from "./server.js";
import { atInstant, fromLocal, key, poseHandle, scene, toLocal } from "./scene.js";
import { arrowLength } from "./plane.js";
import { ofPose } from "./motion.js";
import * as entry from "./entry.js";
import { removeOf } from "./tools.js";
import { angle, leastOf, minus, number, pan, plus, round125, rounded, size, snap, snapStep, toPlane, toScreen, zoom } from "./view.js";

/** Pixels that a pointer may shake without being a drag. */
const STILL = 4;
const TWO_ENDS = ["link", "join"];
let svg, parent;
const fingers = new Map();
let grab = null; // what is held: {handle, from, moved, drag, gesture}
let tapped = { time: 0, handle: null };
let made = null; // handle of a load that is not drawn yet
let nudged = { time: 0, handle: null, gesture: "" };

export function mount(element) {
  svg = element;
  parent = svg.parentElement;
  const hands = { pointerdown: down, pointermove: move, pointerup: up, pointercancel: cancel, keydown: keys, focusin: focused };
  for (const [event, act] of Object.entries(hands)) svg.addEventListener(event, act);
  svg.addEventListener("wheel", wheel, { passive: false });
  document.addEventListener("keydown", typed);
  document.addEventListener("pointerdown", ({ target }) => target.closest?.(".entry, #sheet") || entry.close());
  for (const act of [settle, takeUp, entry.refresh]) store.on("drawn", act);
  store.on("document", settle);
}

const local = (event) => {
  const box = svg.getBoundingClientRect();
  return [event.clientX - box.left, event.clientY - box.top];
};
const under = (event) => document.elementFromPoint(event.clientX, event.clientY)?.handle ?? null;

function focused(event) {
  const { handle } = event.target;
  if (!handle) return;
  svg.querySelector(".last")?.classList.remove("last");
  event.target.classList.add("last");
  if (handle.kind !== "cursor") store.put("selected", handle);
}

function down(event) {
  if (event.button > 1) return;
  const at = local(event);
  fingers.set(event.pointerId, at);
  svg.setPointerCapture(event.pointerId);
  entry.close();
  if (fingers.size === 2) return pinch();
  const { handle = null } = event.button === 1 ? {} : event.target;
  if (handle) {
    (event.target.tip ?? event.target).focus({ preventScroll: true }); // of an arrow its tip
    store.put("selected", handle); // one that has the focus already tells of no new one
  }
  else document.activeElement?.blur();
  const { tool } = store.state;
  grab = { handle, from: at, moved: false, gesture: newGesture(), drag: null };
  if (tool === "select" || event.button === 1) {
    if (!handle) store.put("selected", null);
    grab.drag = handle && !isGround(handle) ? dragOf(handle, toPlane(at)) : null;
    grab.pans = !grab.drag;
  } else if ([...TWO_ENDS, "load"].includes(tool)) {
    grab.second = store.state.ends !== null && tool !== "load";
    if (!grab.second) store.put("ends", endAt(handle, toPlane(at), event.altKey));
  }
}

function move(event) {
  const last = fingers.get(event.pointerId);
  if (!last) return;
  const at = local(event);
  fingers.set(event.pointerId, at);
  if (fingers.size === 2) return spread();
  if (!grab || (!grab.moved && size(minus(at, grab.from)) < STILL)) return;
  grab.moved = true;
  if (grab.pans) pan(...minus(at, last));
  else if (grab.drag) pull(grab.drag(toPlane(at), event.altKey), grab.gesture);
  else if (store.state.ends) store.put("ends", { ...store.state.ends, to: snap(toPlane(at), event.altKey) });
}

function up(event) {
  fingers.delete(event.pointerId);
  const done = grab;
  grab = null;
  if (!done) return;
  settle();
  const { tool } = store.state;
  const place = toPlane(local(event));
  if (done.drag && done.moved) entry.open(parent, done.handle, false);
  else if (tool === "select") tap(done.handle);
  else if (TWO_ENDS.includes(tool)) {
    if (done.second || done.moved) finish(under(event), place, event.altKey);
  } else if (!(tool !== "load" && done.moved)) use(under(event), place, event.altKey);
}

/** Two taps on one thing open its numbers. */
function tap(handle) {
  const twice = handle && same(tapped.handle, handle) && performance.now() - tapped.time < 450;
  tapped = { handle, time: performance.now() };
  if (twice) entry.open(parent, handle, true);
}

function cancel(event) {
  fingers.delete(event.pointerId);
  grab = null;
  store.put("held", null);
}

function pinch() {
  grab = null;
  store.put("ends", null);
  store.put("held", null);
  spread.last = span();
}

const span = () => {
  const [a, b] = [...fingers.values()];
  return { far: size(minus(a, b)), middle: [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2] };
};

function spread() {
  const now = span();
  if (spread.last.far > 0) zoom(now.far / spread.last.far, now.middle);
  pan(...minus(now.middle, spread.last.middle));
  spread.last = now;
}

function wheel(event) {
  event.preventDefault();
  entry.close();
  zoom(Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.0015)), local(event));
}

/* Pulling: each returns what a place means, {operations, held}. */

const isGround = (handle) => handle.kind === "link" && store.state.drawn.links.some((link) => link.name === handle.name && link.ground);

function dragOf(handle, start) {
  const now = scene();
  if (atInstant()) return null;
  if (handle.kind === "joint" || handle.kind === "point") return movingTo(handle);
  if (handle.kind === "load") return forcing(handle, now, start);
  if (handle.kind === "pose") return turning(now, start);
  if (handle.kind === "link") return following(handle, now, start);
  return null;
}

/** What names a joint or a point, the points that it is, and where. */
function spotOf({ kind, name, link, point }, now = scene()) {
  const joint = kind === "joint" && now.joints.find((one) => one.name === name);
  return joint ? { end: { joint: name }, points: joint.points, at: joint.at } : { end: { link, point }, points: [key(link, point)], at: now.at.get(key(link, point)) };
}

function movingTo(handle) {
  const { end, points } = spotOf(handle);
  return (place, free, exact = false) => {
    const to = exact ? place : snap(place, free);
    return { operations: [{ op: "move", ...end, to }], held: { points, at: to, text: `${number(to[0], 5)}, ${number(to[1], 5)} mm` } };
  };
}

/** N to which forces are rounded: a round number that is some 6 px of arrow. */
const forceStep = (per = newtonLength()) => round125(6 / store.state.view.scale / per);
const newtonLength = () => arrowLength() || (0.02 * store.state.drawn?.size) || 1;

function forcing(handle, now, start) {
  const load = now.loads.find((one) => same(one.path, handle.path));
  if (!load) return null;
  const per = newtonLength();
  return (place, free) => {
    const step = forceStep(per) / (free ? 100 : 1);
    return force(load, plus(load.vector, minus(place, start), 1 / per).map((part) => rounded(part, step)), per);
  };
}

function force(load, vector, per = newtonLength()) {
  const text = `${number(size(vector))} N at ${number((angle(vector) * 180) / Math.PI)}°`;
  return { operations: entry.forceOperations(load, scene().links, vector), held: { load: load.path, vector, at: plus(load.at, vector, per), text } };
}

function turn(value, step, at) {
  const { kind, value: now } = store.state.drawn.coordinate;
  const turns = kind === "angle" && store.state.motion?.turns ? Math.round((value - now) / 360) : 0;
  const to = rounded(value - 360 * turns, step);
  return { operations: [{ op: "turn", to }], held: { pose: to, at, text: `${number(to, 5)}${kind === "travel" ? " mm" : "°"}` } };
}

const poseStep = (free) => (store.state.drawn.coordinate.kind === "travel" ? snapStep() : 1) / (free ? 100 : 1);

function turning(now, start) {
  const { pivot, way } = poseHandle(now, 1 / store.state.view.scale);
  const { value } = now.drawn.coordinate;
  let last = angle(minus(start, pivot));
  let total = 0;
  return (place, free) => {
    if (way) return turn(value + (place[0] - start[0]) * way[0] + (place[1] - start[1]) * way[1], poseStep(free), place);
    const next = angle(minus(place, pivot));
    total += Math.atan2(Math.sin(next - last), Math.cos(next - last));
    last = next;
    return turn(value + (total * 180) / Math.PI, poseStep(free), place);
  };
}

/** The pose in which the place where a link was taken is nearest to the pointer. */
function following(handle, now, start) {
  const { motion, drawn } = store.state;
  if (!drawn.coordinate) return null;
  if (!motion?.points) return handle.name === drawn.coordinate.name ? turning(now, start) : null;
  const link = now.links.find((one) => one.name === handle.name);
  const held = toLocal(link, start);
  const [first] = link.points;
  const values = ofPose(motion);
  const path = values.map((_, k) => {
    const direction = motion.angles[link.name][k];
    const at = motion.points[key(link.name, first.name)][k];
    return fromLocal({ origin: minus(at, fromLocal({ origin: [0, 0], direction }, first.local)), direction }, held);
  });
  const { value } = drawn.coordinate;
  let here = leastOf(path.map((_, k) => Math.abs(values[k] - value)));
  return (place, free) => {
    const reach = Math.max(2, Math.round(path.length / 8)); // where paths cross, the hand stays on its own branch
    const away = path.map((at, k) => (Math.abs(k - here) <= reach || (motion.turns && Math.abs(k - here) >= path.length - reach) ? size(minus(at, place)) : Infinity));
    here = leastOf(away);
    return turn(values[here] + between(path, values, here, place), poseStep(free), place);
  };
}

/** How far beyond the nearest instant the pointer is, along the path. */
function between(path, values, k, place) {
  const [before, after] = [Math.max(0, k - 1), Math.min(path.length - 1, k + 1)];
  const chord = minus(path[after], path[before]);
  const long = size(chord) ** 2;
  const off = minus(place, path[k]);
  return long ? ((off[0] * chord[0] + off[1] * chord[1]) / long) * (values[after] - values[before]) : 0;
}

let newest = 0; // revision that the last pull led to

/** Show at once what is pulled, and write it. */
function pull({ operations, held }, gesture) {
  store.put("held", held);
  edit(operations, gesture).then(
    ({ revision }) => {
      newest = revision;
      settle();
    },
    () => store.state.held === held && store.put("held", null),
  );
  newest = Infinity;
}

/** Let go of what was pulled when the server's drawing has it, or can have none. */
function settle() {
  const { document: now, drawn, held } = store.state;
  const known = now?.problem ? now.revision : drawn?.revision;
  if (!held || grab?.moved || known < newest) return;
  store.put("held", null);
  entry.refresh();
}

/* Tools that make something. */

/** A free name P1, P2, ... of a point of a link. */
function newPoint(link) {
  let k = 1;
  while (link.points.some((point) => point.name === `P${k}`)) k += 1;
  return `P${k}`;
}

/** The end that a place means: {end, at, operations to make it, handle}. */
function endAt(handle, place, free) {
  const now = scene();
  const to = snap(place, free);
  if (handle?.kind === "joint" || handle?.kind === "point") return { ...spotOf(handle, now), operations: [], handle };
  if (handle?.kind === "link") {
    const link = now.links.find((one) => one.name === handle.name);
    const point = newPoint(link);
    const spot = link.straight && !link.ground ? [rounded(toLocal(link, place)[0], snapStep()), 0] : toLocal(link, to);
    const value = spot.map((part) => `${Number(part.toFixed(6))} mm`);
    return { end: { link: link.name, point }, at: fromLocal(link, spot), operations: [{ op: "set", path: ["links", link.name, "points", point], value }], handle };
  }
  return { end: { at: to }, at: to, operations: [], handle: null };
}

function finish(handle, place, free) {
  const first = store.state.ends;
  const second = endAt(handle, place, free);
  store.put("ends", null);
  if (!first || same(first.end, second.end)) return;
  if (atInstant()) return;
  const made = [...first.operations, ...second.operations];
  if (store.state.tool === "link") edit([...made, { op: "link", name: null, from: first.end, to: second.end }]);
  else if (first.end.at || second.end.at) tell("A joint takes two points: press on one and release on the other.");
  else edit([...made, { op: "join", ends: [first.end, second.end] }]);
}

/** Use a tool that needs one place. */
function use(handle, place, free) {
  const { tool, ends } = store.state;
  store.put("ends", null);
  if (tool === "remove" && handle) removeOf(handle);
  if (tool === "ground") {
    const one = endAt(handle, place, free);
    if (atInstant()) return;
    if (!handle || isGround(handle)) edit([{ op: "ground", at: one.at }]);
    else edit([...one.operations, { op: "join", ends: [one.end, { ground: one.at }] }]);
  }
  if (tool === "load") addLoad(ends ?? endAt(handle, place, free));
}

function addLoad({ end, at, operations, to }) {
  const now = scene();
  if (!now) return;
  const moves = ({ link }) => now.links.some((one) => one.name === link && !one.ground);
  const named = (joint) => spotOf({ kind: "joint", name: joint }, now).points.map((one) => one.split(".")).map(([link, point]) => ({ link, point }));
  const target = (end.joint ? named(end.joint) : [end]).findLast(moves);
  if (!target) return tell("A load acts on a link that moves: press on a point of one, or on the link itself.");
  const { loadCase, drawn } = store.state;
  const name = drawn.loads.find((load) => load.load_case === loadCase)?.path[1] ?? loadCase ?? "load";
  const drawnForce = to && minus(to, at).map((part) => rounded(part / newtonLength(), forceStep()));
  const vector = drawnForce && size(drawnForce) > 0 ? drawnForce : [0, -10];
  const path = ["load_cases", name, "forces", store.state.document.tables?.load_cases?.[name]?.forces?.length ?? 0];
  made = { kind: "load", path };
  edit([...operations, { op: "load", load_case: name, ...target, force: vector.map((part) => `${part} N`) }]).then(() => store.put("tool", "select"), () => (made = null));
}

/** Select a load that was made once it is drawn, with its numbers ready to be typed. */
function takeUp() {
  if (!made || !scene()?.loads.some((load) => same(load.path, made.path))) return;
  store.put("selected", made);
  entry.open(parent, made, false);
  made = null;
}

/* The keyboard. */

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

function keys(event) {
  const { handle } = event.target;
  if (event.ctrlKey || event.metaKey) return;
  const way = ARROWS[event.key];
  if (way) nudge(handle, way.map((part) => part * (event.shiftKey ? 10 : 1)), event.altKey);
  else if ((event.key === "Enter" || event.key === " ") && handle) enter(handle, event.target);
  else if ((event.key === "+" || event.key === "-") && !entry.isOpen()) zoom(event.key === "+" ? 1.25 : 0.8, [svg.clientWidth / 2, svg.clientHeight / 2]);
  else return;
  event.preventDefault();
}

function enter(handle, target) {
  const { tool, cursor } = store.state;
  if (tool === "select") return entry.open(parent, handle, true);
  const place = handle.kind === "cursor" ? cursor : toPlane([Number(target.getAttribute("cx")), Number(target.getAttribute("cy"))]);
  const thing = handle.kind === "cursor" ? null : handle;
  const where = thing?.kind === "link" ? middle(thing) : place;
  if (!TWO_ENDS.includes(tool)) use(thing, where, true);
  else if (store.state.ends) finish(thing, where, true);
  else store.put("ends", endAt(thing, where, true));
}

function middle(handle) {
  const [[a, b]] = scene().links.find((one) => one.name === handle.name).pieces;
  return plus(a, minus(b, a), 0.5);
}

function nudge(handle, way, free) {
  if (!handle) return pan(-40 * way[0], 40 * way[1]);
  if (handle.kind === "cursor") return store.put("cursor", snap(plus(store.state.cursor, way, snapStep())));
  const now = scene();
  if (atInstant()) return;
  if (performance.now() - nudged.time > 1500 || !same(nudged.handle, handle)) nudged.gesture = newGesture();
  nudged = { ...nudged, time: performance.now(), handle };
  const step = snapStep() / (free ? 100 : 1);
  let pulled = null;
  if (handle.kind === "joint" || handle.kind === "point") {
    pulled = movingTo(handle)(spotOf(handle, now).at.map((one, k) => (way[k] ? rounded(one + way[k] * step, step) : one)), free, true);
  } else if (handle.kind === "load") {
    const load = now.loads.find((one) => same(one.path, handle.path));
    pulled = force(load, load.vector.map((one, k) => rounded(one + way[k] * forceStep() / (free ? 100 : 1), forceStep() / 100)));
  } else if (now.drawn.coordinate && (handle.kind === "pose" || handle.name === now.drawn.coordinate.name)) {
    const value = store.state.held?.pose ?? now.drawn.coordinate.value;
    pulled = turn(value + (way[0] || way[1]) * poseStep(free), poseStep(free), poseHandle(now, 1 / store.state.view.scale).at);
  }
  if (pulled) pull(pulled, nudged.gesture);
}

/** Digits typed after a drag go to the form that stands open. */
function typed(event) {
  if (event.key === "Escape") return escape(event);
  const writing = event.target.closest?.("input, textarea, select, [contenteditable]");
  if (writing || !entry.isOpen() || !/^[-0-9.]$/.test(event.key) || event.ctrlKey || event.metaKey) return;
  parent.querySelector(".entry input").select();
}

function escape(event) {
  if (event.target.closest?.("#panels, .entry")) return;
  if (entry.isOpen()) return entry.close();
  if (grab?.drag && grab.moved) {
    change("undo", {}, grab.gesture).catch(() => {}); // what this pull has changed, if anything
    grab = null;
    store.put("held", null);
  } else if (store.state.ends) store.put("ends", null);
  else if (store.state.tool !== "select") store.put("tool", "select");
  else store.put("selected", null);
}
