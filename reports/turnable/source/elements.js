// HTML elements of the viewer. Texts are set as text, never as HTML: names of links and load cases are data.

/** An element with attributes, and text or children. */
export function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

/** A button. */
export function button(text, title, act) {
  const made = element("button", { type: "button", title, "aria-label": title }, text);
  made.addEventListener("click", act);
  return made;
}

/** Buttons of which one is pressed; `choose` receives its place. */
export function choice(label, titles, chosen, choose) {
  const buttons = titles.map((title, place) => {
    const made = element("button", { type: "button", "aria-pressed": String(place === chosen) }, title);
    made.addEventListener("click", () => {
      buttons.forEach((other) => other.setAttribute("aria-pressed", String(other === made)));
      choose(place);
    });
    return made;
  });
  return element("div", { class: "choice", role: "group", "aria-label": label }, element("span", {}, `${label}: `), ...buttons);
}

let sliders = 0;

/** A slider with its name and its value in words. */
export function slider(label, { low, high, step, value }, told, change) {
  const id = `turnable-slider-${(sliders += 1)}`;
  const input = element("input", { type: "range", id, min: low, max: high, step, value });
  const output = element("output", { for: id });
  const show = () => {
    output.textContent = told(Number(input.value));
    input.setAttribute("aria-valuetext", output.textContent);
  };
  input.addEventListener("input", () => {
    show();
    change(Number(input.value));
  });
  show();
  return { line: element("div", { class: "slider" }, element("label", { for: id }, label), input, output), input, show };
}
