/** The toolbar: what a press in the plane does, undo and redo, saving. */

import { store } from "./store.js";
import { change, edit } from "./server.js";
import { add, make, offer } from "./elements.js";
import { toPlane } from "./view.js";
import { fitAll } from "./plane.js";

const TOOLS = [
  ["select", "Select", "v", "Pull pins, points, arrow tips and links. Double click or Enter: type numbers. Alt: no rounding."],
  ["link", "Add link", "l", "Press on a place, pin or link, and release on another: a link between both."],
  ["ground", "Add ground pin", "g", "Press on a place: a point of the ground. On a pin or an end of a link: it is held there."],
  ["load", "Add load", "f", "Press on a point or a link and pull the arrow of the force."],
  ["join", "Join", "j", "Press on a point and release on another: they become one joint."],
  ["remove", "Remove", "Delete", "Press on what shall go, with all that refers to it; a joint is taken apart."],
];
const named = (key) => (key === "Delete" ? "Del" : key.toUpperCase());

export function mount(element) {
  const chosen = group(element, "What a press does");
  for (const [name, label, key, hint] of TOOLS) {
    const one = button(chosen, label, key, hint, () => choose(name));
    store.on("tool", (tool) => one.setAttribute("aria-pressed", String(tool === name)));
  }
  const steps = group(element, "Steps");
  const undo = button(steps, "Undo", "Ctrl+Z", "", () => change("undo"));
  const redo = button(steps, "Redo", "Ctrl+Y", "", () => change("redo"));
  button(steps, "Fit", "0", "Show all of the linkage", fitAll);
  const keeping = group(element, "File");
  const save = button(keeping, "Save", "Ctrl+S", "", () => change("save"));
  const box = make("input", { type: "checkbox", onchange: () => change("save", { always: box.checked }) });
  add(keeping, "label", { class: "choice" }, box, " autosave");
  loadCases(group(element, "Load case"));
  store.on("document", (now) => {
    undo.disabled = !now.undo;
    redo.disabled = !now.redo;
    save.disabled = now.saved;
    box.checked = Boolean(now.always);
  });
  hint();
  document.addEventListener("keydown", shortcut);
  store.put("tool", "select");
}

const group = (element, label) => add(element, "div", { role: "group", "aria-label": label });

function button(parent, label, key, title, act) {
  const told = { type: "button", title: title || `${label}: ${key}`, "aria-keyshortcuts": key.replace("Ctrl", "Control"), onclick: act };
  return add(parent, "button", told, `${label} `, key.startsWith("Ctrl") ? null : make("kbd", {}, named(key)));
}

/** Take up a tool; removing acts at once on what is selected. */
function choose(name) {
  const { selected, tool } = store.state;
  if (name === "remove" && selected && tool === "select") return removeOf(selected);
  store.put("ends", null);
  const sheet = document.getElementById("sheet");
  store.put("cursor", store.state.view ? toPlane([sheet.clientWidth / 2, sheet.clientHeight / 2]).map(Math.round) : null);
  store.put("tool", name === tool ? "select" : name);
}

/** Remove a thing, with what refers to it. */
export function removeOf(handle) {
  const path = { joint: ["joints", handle.name], link: ["links", handle.name], point: ["links", handle.link, "points", handle.point], load: handle.path }[handle.kind];
  if (!path) return;
  store.put("selected", null);
  edit([{ op: "remove", path }]);
}

/** The load case that is shown: the first one until another is chosen. */
function loadCases(element) {
  const list = make("select", { "aria-label": "Load case", onchange: () => store.put("loadCase", list.value) });
  add(element, "label", { class: "choice" }, make("span", {}, "Load case "), list);
  const show = () => {
    const names = store.state.drawn?.load_cases ?? [];
    offer(list, names);
    if (store.state.drawn && !names.includes(store.state.loadCase)) store.put("loadCase", names[0] ?? null);
    list.value = store.state.loadCase ?? "";
    element.hidden = names.length < 2;
  };
  for (const key of ["drawn", "loadCase"]) store.on(key, show);
  show();
}

/** What a case that is drawn from nothing wants next; "" where something acts on it already, or where something is wrong. */
export function nextStep(now) {
  if (!now?.problem || !now.tables || Object.keys(now.tables.load_cases ?? {}).length) return "";
  const { sentence } = now.problem;
  const [, ways = 0] = sentence.match(/^drive: the linkage has mobility (\d+)/) ?? [];
  if (ways > 1) return `It moves in ${ways} ways, and one is to be left: Add link from a free end to another pin or to the ground.`;
  if (sentence.startsWith("links: it has 1")) return "Begin with Add link: press on a pin of the ground and release where the link shall end.";
  return sentence.startsWith("load_cases: this entry is missing") ? "It moves in one way, as a drive needs it. Add more links, or Add load." : "";
}

/** What the tool that is taken up wants, and what the drawing does. */
function hint() {
  const line = add(document.getElementById("plane"), "p", { id: "hint", "aria-live": "polite" });
  const show = () => {
    const { tool, ends, document: now } = store.state;
    const second = ends && !ends.to ? " Now the second end." : "";
    const wanted = tool === "select" ? "" : (TOOLS.find(([name]) => name === tool)?.[3] ?? "") + second;
    line.textContent = [wanted, nextStep(now)].filter(Boolean).join(" ");
    line.hidden = !line.textContent;
  };
  for (const name of ["tool", "ends", "document"]) store.on(name, show);
}

function shortcut(event) {
  const letter = event.key.toLowerCase();
  if (event.ctrlKey || event.metaKey) {
    const route = { s: "save", z: event.shiftKey ? "redo" : "undo", y: "redo" }[letter];
    const writing = event.target.closest?.("input:not([type=checkbox], [type=range]), textarea");
    if (!route || (writing && route !== "save")) return;
    event.preventDefault();
    if (writing) { // what was typed is sent before it is saved
      writing.blur();
      writing.focus({ preventScroll: true });
    }
    change(route);
    return;
  }
  if (event.defaultPrevented || event.altKey || event.target.closest?.("input, textarea, select, [contenteditable]")) return;
  const tool = TOOLS.find(([, , key]) => key.toLowerCase() === letter || (key === "Delete" && event.key === "Backspace"));
  if (tool) choose(tool[0]);
  else if (letter === "0" && !document.querySelector("#plane .entry")) fitAll();
}
