/** Elements of the panels. Texts are set as text, never as HTML: names of a case are data. */

let count = 0;

/** A name that no other element of the page has. */
export const unused = () => `e${(count += 1)}`;

/** An element with attributes, listeners (`onclick` and the like, as functions), and children; null ones are left out. */
export function make(tag, attributes = {}, ...children) {
  const svg = ["svg", "line", "rect", "text", "g", "title"].includes(tag) && attributes.svg !== false;
  const made = svg ? document.createElementNS("http://www.w3.org/2000/svg", tag) : document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (typeof value === "function") made.addEventListener(name.slice(2), value);
    else made.setAttribute(name, value === true ? "" : value);
  }
  made.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return made;
}

/** A text whose ``parts`` are set as code. */
export function worded(text) {
  return text.split("``").map((part, place) => (place % 2 ? make("code", {}, part) : part));
}

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

/** A number as a reader takes it in: four significant digits. */
export function number(value) {
  if (value === null || value === undefined) return "-";
  if (value === 0) return "0";
  const size = Math.abs(value);
  return size >= 1e6 || size < 1e-4 ? value.toExponential(2) : String(Number(value.toPrecision(4)));
}

/** Hand a file to the reader. */
export function handOut(name, blob) {
  const link = make("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
