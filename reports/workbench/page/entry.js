/** Exact numbers: a small form beside what is chosen. */

import { edit, tell } from "./server.js";
import { store } from "./store.js";
import { atInstant, scene, key } from "./scene.js";
import { add, make } from "./elements.js";
import { minus, number, size, toScreen } from "./view.js";

let form = null;
let renew = null;

export function close() {
  form?.remove();
  form = null;
}

/** Show the numbers as they are now, unless somebody writes. */
export function refresh() {
  if (form && !form.contains(document.activeElement)) renew();
}

export const isOpen = () => form !== null;

/** Operations that change a force; it is written in the axes in which the file states it. */
export function forceOperations(load, links, wanted, alone = false) {
  const turn = load.axes === "link" ? (-(links.find((one) => one.name === load.link)?.direction ?? 0) * Math.PI) / 180 : 0;
  const own = ([x, y]) => [x * Math.cos(turn) - y * Math.sin(turn), x * Math.sin(turn) + y * Math.cos(turn)].map((part) => Number(part.toFixed(6)));
  const before = own(load.vector);
  const set = own(wanted).map((part, k) => ({ op: "set", path: [...load.path, "force", k], value: `${part} N` }));
  const changed = alone ? set.filter(({ value }, k) => value !== `${before[k]} N`) : []; // the other one keeps its unit
  return changed.length ? changed : set;
}

const parsed = (text) => (text ? Number(text.replace(",", ".")) : NaN);

/** The numbers of a thing, null where it is not drawn, each with what a new value does: {at, title, fields: [{label, value, unit}], change(texts, changed)}. */
function asked(handle) {
  const now = scene();
  if (!now) return null;
  const links = now.links.filter((link) => !link.ground);
  /** Lengths of links, or those that end at some points. */
  const lengths = (some, points) => some.flatMap((link) => link.pieces.map((ends, k) => ({ link, ends, names: link.ends[k] })))
    .filter(({ link, names }) => !points || names.some((name) => points.includes(key(link.name, name))))
    .map(({ link, ends, names }) => ({ label: `${link.name} ${names.join("–")}`, value: size(minus(...ends)), unit: "mm",
      make: (text) => ({ op: "length", link: link.name, points: names, value: Number.isFinite(parsed(text)) ? `${parsed(text)} mm` : text }) }));
  /** Sizes of a link's part; links that have it as well are told. */
  const sizes = ({ part }) => ["width", "thickness", "outer_diameter", "inner_diameter"].flatMap((entry) => {
    const [, value] = String(store.state.document.tables?.parts?.[part]?.[entry]).match(/^([\d.]+) mm$/) ?? [];
    const others = links.filter((one) => one.part === part).length - 1;
    return value ? [{ label: `${entry.replace("_", " ")} of ${part}${others ? ` (${others} more ${others > 1 ? "links" : "link"})` : ""}`, value: Number(value), unit: "mm",
      make: (text) => ({ op: "set", path: ["parts", part, entry], value: Number.isFinite(parsed(text)) ? `${parsed(text)} mm` : text }) }] : [];
  });
  /** A place with the lengths of links; what it is moved as. */
  const placed = (at, title, what, points, more = {}) => {
    const fields = [{ label: "x", value: at[0], unit: "mm" }, { label: "y", value: at[1], unit: "mm" }, ...lengths(links, points)];
    const change = (texts, changed) => [...((changed[0] || changed[1]) && !atInstant() ? [{ op: "move", ...what, to: texts.slice(0, 2).map(parsed) }] : []), ...made(fields, texts, changed)];
    return { at, title, fields, change, ...more };
  };
  const made = (fields, texts, changed) => fields.flatMap((field, k) => (field.make && changed[k] ? [field.make(texts[k])] : []));
  const found = {
    joint: () => now.joints.filter((one) => one.name === handle.name).map((joint) => placed(joint.at, `Joint ${joint.name}`, { joint: joint.name }, joint.points)),
    point: () => [now.at.get(key(handle.link, handle.point))].filter(Boolean).map((at) => {
      const what = { link: handle.link, point: handle.point };
      const others = now.links.filter((link) => link.name !== handle.link).map((link) => link.name);
      const choice = { label: "give it to", others, make: (to) => ({ op: "hand", ...what, to }) };
      return placed(at, `Point ${handle.point} of ${handle.link}`, what, [key(handle.link, handle.point)], { choice });
    }),
    link: () => links.filter((one) => one.name === handle.name).map((link) => {
      const fields = [...lengths([link]), ...sizes(link)];
      return { at: link.pieces[0]?.[0] ?? link.origin, title: `Link ${link.name}`, fields, change: (texts, changed) => made(fields, texts, changed) };
    }),
    load: () => now.loads.filter((one) => String(one.path) === String(handle.path)).map((load) => {
      const [x, y] = load.vector;
      const fields = [{ label: "size", value: size(load.vector), unit: "N" }, { label: "direction", value: (Math.atan2(y, x) * 180) / Math.PI, unit: "°" }, { label: "Fx", value: x, unit: "N" }, { label: "Fy", value: y, unit: "N" }];
      const change = (texts, changed) => {
        const [newtons, degrees, fx, fy] = texts.map(parsed);
        const way = (degrees * Math.PI) / 180;
        return forceOperations(load, now.links, changed[0] || changed[1] ? [newtons * Math.cos(way), newtons * Math.sin(way)] : [fx, fy], true);
      };
      return { at: load.at, title: `Load on ${load.link}`, fields, change };
    }),
    pose: () => [now.drawn.coordinate].filter(Boolean).map((pose) => {
      const at = now.links.find((one) => one.name === pose.name)?.origin ?? now.joints.find((one) => one.name === pose.name)?.at ?? [0, 0];
      const fields = [{ label: pose.kind, value: pose.value, unit: pose.kind === "travel" ? "mm" : "°" }];
      return { at, title: `Pose of ${pose.name}`, fields, change: ([text]) => [{ op: "turn", to: parsed(text) }] };
    }),
  };
  return found[handle.kind]?.()[0] ?? null;
}

/** Open the form of a thing; with `focus` the first number is ready to be overwritten. */
export function open(parent, handle, focus) {
  close();
  renew = () => open(parent, handle, false);
  const what = asked(handle);
  if (!what?.fields.length) return;
  form = add(parent, "form", { class: "entry", "aria-label": what.title, autocomplete: "off", novalidate: "" });
  const shown = what.fields.map(({ value }) => number(value, 6));
  const inputs = what.fields.map(({ label, unit }, k) => make("input", { inputmode: "decimal", size: 9, "aria-label": `${label} in ${unit}`, value: shown[k] }));
  const { label, others = [], make: chosen } = what.choice ?? {};
  const choices = ["", ...others].map((name) => make("option", { value: name }, name || "–"));
  const choice = make("select", { onchange: () => finish(parent, [chosen(choice.value)]) }, choices);
  form.append(make("strong", {}, what.title), ...what.fields.map((field, k) => make("label", {}, `${field.label} `, inputs[k], ` ${field.unit}`)),
    ...(others.length ? [make("label", {}, `${label} `, choice)] : []), make("button", { type: "submit" }, "Set"));
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const texts = inputs.map((input) => input.value.trim());
    const changed = texts.map((text, k) => text !== shown[k]);
    const wrong = what.fields.findIndex((field, k) => changed[k] && !field.make && !Number.isFinite(parsed(texts[k])));
    if (wrong >= 0) {
      tell(`${what.fields[wrong].label}: '${texts[wrong]}' is no number; write how many ${what.fields[wrong].unit} it is.`);
      return inputs[wrong].select();
    }
    finish(parent, changed.some(Boolean) ? what.change(texts, changed) : []);
  });
  form.addEventListener("keydown", (event) => event.key === "Escape" && finish(parent, []));
  beside(parent, toScreen(what.at));
  if (focus) inputs[0].select();
}

function finish(parent, operations) {
  close();
  if (operations.length) edit(operations);
  parent.querySelector("[tabindex].last")?.focus();
}

/** Put the form beside a place, where it is seen. */
function beside(parent, [x, y]) {
  const { clientWidth, clientHeight } = parent;
  form.classList.toggle("above", y > clientHeight / 2); // on a narrow page it takes the other half
  const left = x + 28 + form.offsetWidth < clientWidth ? x + 28 : x - 28 - form.offsetWidth;
  form.style.left = `${Math.min(Math.max(left, 4), Math.max(4, clientWidth - form.offsetWidth - 4))}px`;
  form.style.top = `${Math.min(Math.max(y + 14, 4), Math.max(4, clientHeight - form.offsetHeight - 4))}px`;
}
