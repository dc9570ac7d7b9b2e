// What the colours mean: a bar with round values and their unit.

import { element } from "./elements.js";
import { colours } from "./surface.js";
import { plain } from "./words.js";

/** A legend from `low` to `high`; `beyond` tells that some value lies above and has the last colour too. */
export class Legend {
  constructor(title, table, low, high) {
    this.bar = element("canvas", { width: "256", height: "1", "aria-hidden": "true" });
    const pen = this.bar.getContext("2d");
    colours(table).forEach(([red, green, blue], place) => {
      pen.fillStyle = `rgb(${red},${green},${blue})`;
      pen.fillRect(place, 0, 1, 1);
    });
    const scale = element("div", { class: "scale" });
    for (const value of ticks(low, high)) {
      const mark = element("span", {}, plain(value));
      mark.style.left = `${(100 * (value - low)) / (high - low)}%`;
      scale.append(mark);
    }
    this.tip = element("span", { class: "tip", title: "Larger values have the last colour too." }, "▶");
    this.facts = element("div", { class: "facts" });
    this.box = element("div", { class: "legend", role: "group", "aria-label": `Legend: ${title}` },
      element("div", { class: "title" }, title), element("div", { class: "bar" }, this.bar, this.tip), scale, this.facts);
  }

  /** Show whether values lie beyond the last colour, and lines of text. */
  tell(lines, beyond) {
    this.tip.hidden = !beyond;
    this.facts.replaceChildren(...lines.map((line) => element("div", {}, line)));
  }
}

/** Round values from one to another, some five. */
export function ticks(low, high) {
  const step = [1, 2, 2.5, 5, 10].map((digit) => digit * 10 ** Math.floor(Math.log10((high - low) / 5)))
    .find((size) => (high - low) / size <= 6);
  const first = Math.ceil(low / step - 1e-9);
  const count = Math.floor(high / step + 1e-9) - first;
  return Array.from({ length: count + 1 }, (_, k) => Number(((first + k) * step).toPrecision(12)));
}
