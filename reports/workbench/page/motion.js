/** The motion: a slider over its instants, play, paths of points, dead points, and taking over a pose. */

import { store } from "./store.js";
import { edit } from "./server.js";
import { make } from "./elements.js";
import { leastOf, number } from "./view.js";

/** Seconds that the whole motion takes on the page. */
const SECONDS = 5;
let parts, playing = null;

export function mount(element) {
  const button = (label, act, more = {}) => make("button", { type: "button", onclick: act, ...more }, label);
  const box = make("input", { type: "checkbox", onchange: () => store.put("paths", box.checked) });
  const slid = () => {
    const to = Number(parts.slider.value); // read first: to stop shows the old instant again
    stop();
    store.put("instant", to);
  };
  parts = {
    element,
    play: button("Play", () => (playing ? stop() : start())),
    slider: make("input", { type: "range", min: 0, step: 1, "aria-label": "Instant of the motion", oninput: slid }),
    ends: [make("small"), make("small")],
    dead: make("svg", { class: "dead", "aria-hidden": "true" }),
    said: make("output"),
    one: button("", () => edit([{ op: "set", path: ["motion"], value: store.state.motion.offer }]), { hidden: true }),
    use: button("Use this pose", take, { class: "kept" }),
    back: button("Back to the case's pose", leave, { class: "kept" }),
  };
  const { play, slider, ends, dead, said, one, use, back } = parts;
  element.append(play, ends[0], make("div", { class: "track" }, slider, dead), ends[1], said, use, back, make("label", { class: "choice" }, box, " paths of points"), one);
  store.on("motion", () => {
    const { motion, instant } = store.state;
    if (instant !== null && !(instant < motion?.values?.length)) leave();
    show();
  });
  for (const name of ["instant", "drawn", "document"]) store.on(name, show);
  show();
}

function leave() {
  stop();
  store.put("instant", null);
}

function take() {
  const { motion, instant } = store.state;
  const value = ofPose(motion)[instant];
  stop();
  edit([{ op: "turn", to: Number(value.toFixed(6)) }]).then(() => store.put("instant", null), () => {});
}

function start() {
  const { motion } = store.state;
  const count = motion.values.length;
  const begin = performance.now() - ((store.state.instant ?? nearest()) / count) * SECONDS * 1000;
  const run = (time) => {
    const phase = Math.max(0, (time - begin) / 1000 / SECONDS);
    const share = motion.turns ? phase % 1 : 1 - Math.abs(1 - (phase % 2)); // a motion with ends goes to and fro
    store.put("instant", Math.min(count - 1, Math.floor(share * count)));
    playing = requestAnimationFrame(run);
  };
  playing = requestAnimationFrame(run);
  show();
}

function stop() {
  if (playing) cancelAnimationFrame(playing);
  playing = null;
  show();
}

/** The coordinate of the pose at each instant; the motion may prescribe another one. */
export const ofPose = (motion) => motion.pose ?? motion.values;

/** The pose's coordinate where the motion ends and is dead, or where one would that could be stated. */
export function reachOf(motion) {
  const free = motion?.offer?.range?.map(Number.parseFloat);
  if (motion?.offer) return { ends: free ?? [0, 360], dead: free ?? [], turns: !free };
  if (!motion?.values) return null;
  const values = ofPose(motion);
  const dead = motion.dead.map((to) => (motion.pose ? values[leastOf(motion.values.map((one) => Math.abs(one - to)))] : to));
  return { ends: [Math.min(...values), Math.max(...values)], dead, turns: motion.turns };
}

/** The instant nearest to the case's own pose. */
function nearest() {
  const { motion, drawn } = store.state;
  const value = drawn?.coordinate?.value ?? ofPose(motion)[0];
  const far = (one) => (motion.turns ? Math.abs(((((one - value) % 360) + 540) % 360) - 180) : Math.abs(one - value));
  return leastOf(ofPose(motion).map(far));
}

function show() {
  const { motion, instant } = store.state;
  const moves = Boolean(motion?.values?.length);
  for (const one of [parts.play, parts.slider]) one.disabled = !moves;
  parts.use.hidden = parts.back.hidden = instant === null;
  parts.play.setAttribute("aria-pressed", String(playing !== null));
  parts.play.textContent = playing ? "Pause" : "Play";
  parts.element.hidden = !motion;
  for (const end of parts.ends) end.hidden = !moves;
  if (!moves) {
    const told = store.state.document?.problem?.sentence === motion?.problem; // it stands above the drawing already
    const none = motion?.problem && !told && !store.state.document?.tables?.motion;
    parts.said.textContent = parts.said.title = none ? "no motion is stated" : (!told && motion?.problem) || "no motion";
    const { offer } = motion ?? {};
    parts.one.hidden = !none || !offer;
    parts.one.textContent = offer?.turn ? "Let it turn once" : "Let it move";
    parts.dead.replaceChildren();
    return;
  }
  parts.one.hidden = true;
  const { values, unit } = motion;
  const signs = unit === "deg" ? "°" : ` ${unit}`;
  const k = instant ?? nearest();
  parts.slider.max = values.length - 1;
  parts.slider.value = k;
  for (const [place, end] of parts.ends.entries()) end.textContent = number(motion.range[place]) + signs;
  const more = [...(motion.turns ? ["turns fully"] : []), ...(motion.dead.length ? [`dead ${motion.dead.map((one) => number(one) + signs).join(", ")}`] : [])];
  const text = `${number(instant === null && !motion.pose ? store.state.drawn?.coordinate?.value ?? values[k] : values[k], 4)}${signs}`;
  parts.slider.setAttribute("aria-valuetext", text);
  parts.said.textContent = parts.said.title = [text, ...more].join(", ");
  const share = (value) => `${(100 * (value - values[0])) / (values.at(-1) - values[0] || 1)}%`;
  parts.dead.replaceChildren(...motion.dead.map((value) => make("line", { x1: share(value), x2: share(value), y1: 0, y2: 8 })));
}
