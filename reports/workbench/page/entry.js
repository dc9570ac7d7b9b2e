/** Exact numbers: a small form beside what is chosen. */

import { edit, tell } from "./server.js";
import { scene, key } from "./scene.js";
import { add } from "./svg.js";
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
export function forceOperations(load, links, [x, y]) {
  const turn = load.axes === "link" ? (-links.find((one) => one.name === load.link).direction * Math.PI) / 180 : 0;
  const own = [x * Math.cos(turn) - y * Math.sin(turn), x * Math.sin(turn) + y * Math.cos(turn)];
  return own.map((part, k) => ({ op: "set", path: [...load.path, "force", k], value: `${Number(part.toFixed(6))} N` }));
}

const parsed = (text) => (text ? Number(text.replace(",", ".")) : NaN);

/** The numbers of a thing, null where it is not drawn, each with what a new value does: {at, title, fields: [{label, value, unit}], change(texts, changed)}. */
function asked(handle) {
  const now = scene();
  const place = (at) => [{ label: "x", value: at[0], unit: "mm" }, { label: "y", value: at[1], unit: "mm" }];
  const lengths = (links, point) => links.filter((link) => !link.ground).flatMap((link) => link.pieces.map((ends, k) => ({ link, ends, names: names(link)[k] })))
    .filter(({ link, names: both }) => !point || both.some((name) => point.includes(key(link.name, name))))
    .map(({ link, ends, names: both }) => ({ label: `${link.name} ${both.join("–")}`, value: size(minus(...ends)), unit: "mm",
      make: (text) => ({ op: "length", link: link.name, points: both, value: Number.isFinite(parsed(text)) ? `${parsed(text)} mm` : text }) }));
  const names = (link) => now.drawn.links.find((one) => one.name === link.name).pieces;
  const moves = (what) => (texts, changed) => [
    ...(changed[0] || changed[1] ? [{ op: "move", ...what, to: texts.slice(0, 2).map(parsed) }] : []), ...made(texts, changed)];
  let fields;
  const made = (texts, changed) => fields.flatMap((field, k) => (field.make && changed[k] ? [field.make(texts[k])] : []));
  if (handle.kind === "joint") {
    const joint = now.joints.find((one) => one.name === handle.name);
    if (!joint) return null;
    fields = [...place(joint.at), ...lengths(now.links.filter((link) => joint.links.includes(link.name)), joint.points)];
    return { at: joint.at, title: `Joint ${joint.name}`, fields, change: moves({ joint: joint.name }) };
  }
  if (handle.kind === "point") {
    const at = now.at.get(key(handle.link, handle.point));
    if (!at) return null;
    fields = [...place(at), ...lengths(now.links.filter((link) => link.name === handle.link), [key(handle.link, handle.point)])];
    const others = now.links.filter((link) => link.name !== handle.link).map((link) => link.name);
    const hand = (to) => ({ op: "hand", link: handle.link, point: handle.point, to });
    return { at, title: `Point ${handle.point} of ${handle.link}`, fields, change: moves({ link: handle.link, point: handle.point }), choice: { label: "give it to", others, make: hand } };
  }
  if (handle.kind === "link") {
    const link = now.links.find((one) => one.name === handle.name);
    if (!link) return null;
    fields = lengths([link]);
    return { at: link.pieces[0]?.[0] ?? link.origin, title: `Link ${link.name}`, fields, change: made };
  }
  if (handle.kind === "load") {
    const load = now.loads.find((one) => String(one.path) === String(handle.path));
    if (!load) return null;
    const [x, y] = load.vector;
    fields = [{ label: "size", value: size(load.vector), unit: "N" }, { label: "direction", value: (Math.atan2(y, x) * 180) / Math.PI, unit: "°" }, { label: "Fx", value: x, unit: "N" }, { label: "Fy", value: y, unit: "N" }];
    const change = (texts, changed) => {
      const [newtons, degrees, fx, fy] = texts.map(parsed);
      const way = (degrees * Math.PI) / 180;
      return forceOperations(load, now.links, changed[0] || changed[1] ? [newtons * Math.cos(way), newtons * Math.sin(way)] : [fx, fy]);
    };
    return { at: load.at, title: `Load on ${load.link}`, fields, change };
  }
  const pose = now.drawn.coordinate;
  if (!pose) return null;
  const at = now.links.find((one) => one.name === pose.name)?.origin ?? now.joints.find((one) => one.name === pose.name)?.at ?? [0, 0];
  fields = [{ label: pose.kind, value: pose.value, unit: pose.kind === "travel" ? "mm" : "°" }];
  return { at, title: `Pose of ${pose.name}`, fields, change: ([text]) => [{ op: "turn", to: parsed(text) }] };
}

/** Open the form of a thing; with `focus` the first number is ready to be overwritten. */
export function open(parent, handle, focus) {
  close();
  renew = () => open(parent, handle, false);
  const what = asked(handle);
  if (!what?.fields.length) return;
  form = add(parent, "form", { class: "entry", "aria-label": what.title, autocomplete: "off", novalidate: "" });
  add(form, "strong", {}, what.title);
  const shown = what.fields.map(({ value }) => number(value, 6));
  const inputs = what.fields.map(({ label, unit }, k) => {
    const row = add(form, "label", {}, `${label} `);
    const input = add(row, "input", { inputmode: "decimal", size: 9, "aria-label": `${label} in ${unit}` });
    input.value = shown[k];
    row.append(` ${unit}`);
    return input;
  });
  if (what.choice?.others.length) {
    const select = add(add(form, "label", {}, `${what.choice.label} `), "select", {});
    for (const name of ["", ...what.choice.others]) add(select, "option", { value: name }, name || "–");
    select.addEventListener("change", () => finish(parent, [what.choice.make(select.value)]));
  }
  add(form, "button", { type: "submit" }, "Set");
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
