/** The text of the case: with line numbers, and what is wrong at its line. */

import { make } from "./elements.js";
import { change, newGesture, tell } from "./server.js";

const PAUSE = 300; // ms after the last key until the text is sent
export function mount(holder, store) {
  const numbers = make("pre", { class: "numbers", "aria-hidden": "true" });
  const area = make("textarea", { "aria-label": "Text of the case", spellcheck: "false", autocomplete: "off", autocapitalize: "off", wrap: "off", "aria-describedby": "text-wrong" });
  const wrong = make("p", { class: "at-line", id: "text-wrong", hidden: true });
  const editor = make("div", { class: "editor" }, numbers, area, wrong);
  holder.append(editor);
  let [base, revision] = ["", -1]; // what the server is known to have: what stands here, but for what is typed
  let sending = false;
  let typed = null; // the timer until that is sent
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

  /** What a text has in place of a range of another. */
  function difference(was, text) {
    let from = 0;
    while (from < was.length && was[from] === text[from]) from += 1;
    let tail = 0;
    while (tail < was.length - from && tail < text.length - from && was.at(-1 - tail) === text.at(-1 - tail)) tail += 1;
    return { from, to: was.length - tail, put: text.slice(from, text.length - tail) };
  }

  /** Take in what the server has; what is typed stays, and so do caret and scroll. Where both are in one line, the reader is told. */
  function take(text) {
    const [theirs, mine] = [text, area.value].map((one) => difference(base, one));
    const apart = (one, other) => base.slice(one.to, other.from).includes("\n");
    const ahead = area.value === base || apart(theirs, mine);
    const clash = text !== area.value && !ahead && !apart(mine, theirs);
    base = text;
    if (clash) return tell("Another page or program has changed the lines in which you write. Your text stands; Undo shows the other one.");
    if (text === area.value) return;
    const shift = ahead ? 0 : mine.put.length - (mine.to - mine.from);
    const top = area.scrollTop;
    area.setRangeText(theirs.put, theirs.from + shift, theirs.to + shift, "preserve");
    area.scrollTop = top;
  }

  function show(now) {
    if (!now) return;
    if (!sending && now.revision > revision) {
      take(now.text.replaceAll("\r\n", "\n"));
      revision = now.revision;
      if (area.value !== base) later();
    }
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
    if (line) area.scrollTop = (line - 1) * lines() - area.clientHeight / 3;
    follow();
  }

  function later() {
    clearTimeout(typed);
    typed = setTimeout(sendTyped, PAUSE);
  }

  async function sendTyped() {
    clearTimeout(typed);
    const text = area.value;
    if (sending || text === base) return;
    sending = true;
    const end = store.state.document.text.includes("\r\n") ? "\r\n" : "\n"; // a text area has lost it
    const answer = await change("text", { text: text.replaceAll("\n", end), revision }, gesture).catch(() => null); // the sentence stands above the page
    sending = false;
    if (answer) [base, revision] = [text, answer.revision];
    if (answer && area.value !== base) later();
    show(store.state.document);
  }

  for (const act of [number, later]) area.addEventListener("input", act);
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
