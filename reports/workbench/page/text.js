/** The text of the case: with line numbers, and what is wrong at its line. */

import { make } from "./elements.js";
import { change, newGesture } from "./server.js";

const PAUSE = 300; // ms after the last key until the text is sent
export function mount(holder, store) {
  const numbers = make("pre", { class: "numbers", "aria-hidden": "true" });
  const area = make("textarea", { "aria-label": "Text of the case", spellcheck: "false", autocomplete: "off", autocapitalize: "off", wrap: "off", "aria-describedby": "text-wrong" });
  const wrong = make("p", { class: "at-line", id: "text-wrong", hidden: true });
  const editor = make("div", { class: "editor" }, numbers, area, wrong);
  holder.append(editor);
  let typed = null; // the timer of what was typed and not sent
  let gesture = newGesture();
  const lines = () => Number.parseFloat(getComputedStyle(area).lineHeight);

  /** Put an element at a line; positions are set by script, since the page's policy knows no style attributes. */
  function place(element, line) {
    const top = (line - 1) * lines() - area.scrollTop + Number.parseFloat(getComputedStyle(area).paddingTop);
    const below = top + lines() + element.offsetHeight <= area.clientHeight;
    element.style.setProperty("top", `${below ? top + lines() : top - element.offsetHeight}px`);
  }

  function follow() {
    numbers.scrollTop = area.scrollTop;
    const line = store.state.document?.problem?.line;
    if (line) place(wrong, line);
  }

  function number() {
    const count = area.value.split("\n").length;
    const bad = store.state.document?.problem?.line;
    numbers.replaceChildren(...Array.from({ length: count }, (_, k) => (k + 1 === bad ? make("b", {}, `${k + 1}\n`) : `${k + 1}\n`)));
  }

  /** Take a new text; caret and scroll stay with what they stood at. */
  function take(text) {
    const was = area.value;
    if (was === text) return;
    let same = 0;
    while (same < was.length && was[same] === text[same]) same += 1;
    let tail = 0;
    while (tail < was.length - same && tail < text.length - same && was.at(-1 - tail) === text.at(-1 - tail)) tail += 1;
    const top = area.scrollTop;
    area.setRangeText(text.slice(same, text.length - tail), same, was.length - tail, "preserve");
    area.scrollTop = top;
  }

  function show(now) {
    if (!now) return;
    if (typed === null) take(now.text.replaceAll("\r\n", "\n"));
    number();
    const { sentence, line } = now.problem ?? {};
    wrong.textContent = sentence ?? "";
    wrong.hidden = !line;
    area.setAttribute("aria-invalid", String(Boolean(sentence)));
    follow();
  }

  /** The panel was opened: what is wrong is seen. */
  function opened() {
    const line = store.state.document?.problem?.line;
    if (!line) return;
    const top = (line - 1) * lines();
    if (top < area.scrollTop || top > area.scrollTop + area.clientHeight - 3 * lines()) area.scrollTop = Math.max(0, top - area.clientHeight / 3);
    follow();
  }

  function sendTyped() {
    clearTimeout(typed);
    if (typed === null) return;
    typed = null;
    const end = store.state.document.text.includes("\r\n") ? "\r\n" : "\n"; // a text area has lost it
    change("text", { text: area.value.replaceAll("\n", end) }, gesture).catch(() => {}); // the sentence stands above the page
  }

  area.addEventListener("input", () => {
    number();
    clearTimeout(typed);
    typed = setTimeout(sendTyped, PAUSE);
  });
  area.addEventListener("blur", () => {
    sendTyped();
    gesture = newGesture(); // what is typed when one comes back is another step
  });
  area.addEventListener("keydown", (event) => (event.ctrlKey || event.metaKey) && sendTyped()); // before it is saved
  area.addEventListener("scroll", follow);
  store.on("document", show);
  store.on("panel", (name) => name === "text" && requestAnimationFrame(opened));
  show(store.state.document);
}
