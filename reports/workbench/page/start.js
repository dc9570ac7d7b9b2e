/** What one starts from while no case is open: cases of the folder, and built-in ones to copy. */

import { store } from "./store.js";
import { change, send, tell } from "./server.js";
import { make } from "./elements.js";

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
  const told = make("p", { role: "alert" });
  store.on("notice", (notice) => (told.textContent = notice?.sentence ?? ""));
  const name = make("input", { "aria-label": "Name of the new file", spellcheck: "false", value: proposed });
  const button = (text, title, body, more = {}) => [make("button", { type: "button", onclick: () => change("open", body()).catch(() => {}), ...more }, text), ` ${title}`];
  const begin = ({ name: starter }) => () => ({ starter, as: name.value.trim() });
  const [drawing, ...gallery] = starters;
  element.replaceChildren(
    told, make("h2", {}, "Begin a case"), make("label", {}, "Its file ", name, ` in ${folder}`),
    make("p", {}, drawing ? button("Draw a linkage", drawing.title, begin(drawing), { class: "first" }) : null),
    make("p", {}, "Or start from a copy of one that is ready:"),
    make("ul", {}, gallery.map((one) => make("li", {}, button(one.name, one.title, begin(one))))));
  if (files.length) element.append(make("h2", {}, `Open a case of ${folder}`), make("ul", {}, files.map((path) => make("li", {}, button(path, "", () => ({ path }))))));
}
