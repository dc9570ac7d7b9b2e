/** What one starts from while no case is open: cases of the folder, and built-in ones to copy. */

import { store } from "./store.js";
import { change, send, tell } from "./server.js";
import { add } from "./elements.js";

export function mount(element) {
  let shown = false;
  store.on("document", (now) => {
    element.hidden = now.path !== null;
    for (const id of ["tools", "work"]) document.getElementById(id).hidden = !element.hidden;
    if (!element.hidden && !shown) show(element);
    shown = !element.hidden;
  });
}

async function show(element) {
  const { starters, files, folder, new: proposed } = await send("starters").catch((problem) => {
    tell(problem.message);
    return { starters: [], files: [], folder: "", new: "" };
  });
  element.replaceChildren();
  const told = add(element, "p", { role: "alert" });
  store.on("notice", (notice) => (told.textContent = notice?.sentence ?? ""));
  add(element, "h2", {}, "Begin a case");
  const label = add(element, "label", {}, "Its file ");
  const name = add(label, "input", { "aria-label": "Name of the new file", spellcheck: "false" });
  name.value = proposed;
  label.append(` in ${folder}`);
  const begin = (starter) => () => ({ starter, as: name.value.trim() });
  const drawing = add(element, "p");
  for (const one of starters.slice(0, 1)) button(drawing, "Draw a linkage", one.title, begin(one.name)).className = "first";
  add(element, "p", {}, "Or start from a copy of one that is ready:");
  const gallery = add(element, "ul");
  for (const one of starters.slice(1)) button(add(gallery, "li"), one.name, one.title, begin(one.name));
  if (!files.length) return;
  add(element, "h2", {}, `Open a case of ${folder}`);
  const here = add(element, "ul");
  for (const file of files) button(add(here, "li"), file, "", () => ({ path: file }));
}

function button(row, text, title, body) {
  const one = add(row, "button", { type: "button" }, text);
  one.addEventListener("click", () => change("open", body()).catch(() => {}));
  row.append(` ${title}`);
  return one;
}
