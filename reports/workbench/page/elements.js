/** Elements of the panels. Texts are set as text, never as HTML: names of a case are data. */

import { number as short } from "./view.js";

let count = 0;

/** Let a choice have these names, anew only where they differ. */
export function offer(select, names) {
  if (names.join("\n") === [...select.options].map((one) => one.value).join("\n")) return;
  select.replaceChildren(...names.map((name) => make("option", { value: name }, name)));
}

/** A name that no other element of the page has. */
export const unused = () => `e${(count += 1)}`;

const SPACE = "http://www.w3.org/2000/svg";
const DRAWN = ["svg", "line", "rect", "text", "g", "title", "path", "circle", "defs", "pattern"];

/** Set attributes, and listeners (`onclick` and the like, as functions); null and false take an attribute away. */
export function set(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) element.removeAttribute(name);
    else if (typeof value === "function") element.addEventListener(name.slice(2), value);
    else if (element.getAttribute(name) !== String(value)) element.setAttribute(name, value === true ? "" : value);
  }
  return element;
}

/** An element with attributes, listeners and children; null ones are left out. */
export function make(tag, attributes = {}, ...children) {
  const made = set(DRAWN.includes(tag) ? document.createElementNS(SPACE, tag) : document.createElement(tag), attributes);
  made.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return made;
}

/** The same as the last child of a parent. */
export const add = (parent, ...what) => parent.appendChild(make(...what));

/** A text whose ``parts`` are set as code. */
export const worded = (text) => text.split("``").map((part, place) => (place % 2 ? make("code", {}, part) : part));

/** A button that copies a text, with the text beside it. */
export function command(text) {
  const told = make("span", { role: "status", class: "soft" });
  const code = make("code", { tabindex: "0" }, text);
  const copy = async () => {
    try {
      await navigator.clipboard.writeText(text);
      told.textContent = " copied";
    } catch {
      getSelection().selectAllChildren(code);
      told.textContent = " marked: copy it with Ctrl+C";
    }
  };
  return make("span", { class: "command" }, code, " ", make("button", { type: "button", onclick: copy }, "Copy"), told);
}

/** Draw a box anew; who stood in it by keyboard stands at the same place afterwards. */
export function keepingFocus(box, draw) {
  const stops = () => [...box.querySelectorAll("a[href], button, input, select, textarea, summary, [tabindex]")];
  const place = stops().indexOf(document.activeElement);
  draw();
  if (place < 0 || box.contains(document.activeElement)) return;
  const now = stops();
  now[Math.min(place, now.length - 1)]?.focus({ preventScroll: true });
}

/** What calls a function before the browser shows its next frame, once, however often it is asked to. */
export function perFrame(draw) {
  let asked = null;
  return () => (asked ??= requestAnimationFrame(() => {
    asked = null;
    draw();
  }));
}

/** A number as a reader takes it in: four significant digits. */
export const number = (value) => (value === null || value === undefined ? "-" : short(value, 4));

/** The name that is wished, or the first like it that is free. */
export function free(wish, taken) {
  for (let count = 1; ; count += 1) {
    const name = count === 1 ? wish : `${wish}-${count}`;
    if (!taken.includes(name)) return name;
  }
}

/** Hand a file to the reader. */
export function handOut(name, blob) {
  const link = make("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** A group whose elements stay between two drawings, by key: what has the focus or a finger keeps it. */
export class Group {
  constructor(parent, attributes = {}) {
    this.element = add(parent, "g", attributes);
    this.kept = new Map();
    this.seen = new Set();
  }

  put(key, tag, attributes, text = null) {
    let element = this.kept.get(key);
    if (!element) this.kept.set(key, (element = add(this.element, tag)));
    set(element, attributes);
    if (text !== null && element.textContent !== text) element.textContent = text;
    this.seen.add(key);
    return element;
  }

  /** Take away what was not drawn since this was last called, and put the rest in order; what has the focus stays. */
  end() {
    for (const [key, element] of this.kept) {
      if (this.seen.has(key)) continue;
      element.remove();
      this.kept.delete(key);
    }
    const order = [...this.seen].map((key) => this.kept.get(key));
    const apart = order.some((element, k) => element !== this.element.children[k]);
    if (apart && !this.element.contains(document.activeElement)) this.element.append(...order);
    this.seen.clear();
  }
}
