/** Texts that find room beside what they name. */

import { minus, plus, size } from "./view.js";

const HIGH = 15;
const pen = document.createElement("canvas").getContext("2d");
pen.font = '12.5px system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", "Liberation Sans", sans-serif';
const widths = new Map();

function wide(text) {
  if (!widths.has(text)) widths.set(text, pen.measureText(text).width + 4);
  return widths.get(text);
}

/** Places on the screen along a line, near enough for a label not to slip between them. */
export function along(a, b) {
  const count = Math.max(1, Math.ceil(size(minus(b, a)) / 7));
  return Array.from({ length: count + 1 }, (_, k) => plus(a, minus(b, a), k / count));
}

const inside = ([x, y], box) => x > box[0] && x < box[2] && y > box[1] && y < box[3];
const overlap = (a, b) => a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];

const WAYS = Array.from({ length: 16 }, (_, k) => (k * Math.PI) / 8);

/** Boxes about an anchor where a text may stand, the nearest first. */
function* boxes(anchor, text, gap, way, near) {
  const half = [wide(text) / 2, HIGH / 2];
  for (const far of near ? [gap, gap + 8] : [gap, gap + 9, gap + 20, gap + 36]) {
    const ways = way === null ? WAYS : [...WAYS].sort((a, b) => Math.cos(b - way) - Math.cos(a - way));
    for (const at of ways) {
      const middle = [anchor[0] + Math.cos(at) * (far + half[0]), anchor[1] + Math.sin(at) * (far + half[1])];
      yield [middle[0] - half[0], middle[1] - half[1], middle[0] + half[0], middle[1] + half[1]];
    }
  }
}

/** A box for each label {text, anchors, gap, way, needed, near}, in the order in which they choose; null for one that has no room and is not needed. Places that are taken stay free of text; the frame is what is seen. */
export function place(labels, taken, frame) {
  const found = [];
  for (const label of labels) {
    let best = null, least = Infinity;
    for (const anchor of label.anchors) {
      if (!inside(anchor, frame)) continue;
      for (const box of boxes(anchor, label.text, label.gap ?? 7, label.way ?? null, label.near)) {
        const out = box[0] < frame[0] || box[1] < frame[1] || box[2] > frame[2] || box[3] > frame[3];
        const cost = 5 * found.filter((other) => other && overlap(other, box)).length + (out ? 8 : 0)
          + taken.filter((one) => inside(one, box)).length;
        if (cost < least) [best, least] = [box, cost];
        if (!cost) break;
      }
      if (!least) break;
    }
    found.push(least === 0 || (label.needed && least < Infinity) ? best : null);
  }
  return found;
}
