/** Where places of the plane [mm] are on the screen [px], and how numbers are written and rounded. */

import { store } from "./store.js";

/** 1, 2 or 5 times a power of ten, not below a value. */
export function round125(value) {
  const power = 10 ** Math.floor(Math.log10(value) + 1e-9);
  return [1, 2, 5, 10].map((step) => step * power).find((step) => step >= value * (1 - 1e-9));
}

/** Which of some numbers is the least. */
export const leastOf = (list) => list.reduce((best, one, k) => (one < list[best] ? k : best), 0);

/** The nearest multiple of a step, without the dust of floating point. */
export const rounded = (value, step) => Number((Math.round(value / step) * step).toPrecision(12)) || 0;

/** A number for people: three digits that count, none before the point lost. */
export function number(value, digits = 3) {
  const size = Math.abs(value);
  if (size < 1e-8) return "0";
  if (size >= 1e7) return value.toExponential(digits - 1);
  const behind = Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
  return String(Number(value.toFixed(Math.min(behind, 12))));
}

export const minus = (a, b) => [a[0] - b[0], a[1] - b[1]];
export const plus = (a, b, times = 1) => [a[0] + times * b[0], a[1] + times * b[1]];
export const size = (a) => Math.hypot(a[0], a[1]);
export const angle = (a) => Math.atan2(a[1], a[0]);
export const turned = (a, by) => [a[0] * Math.cos(by) - a[1] * Math.sin(by), a[0] * Math.sin(by) + a[1] * Math.cos(by)];

/** The view is {scale [px/mm], left [px], top [px]} of the plane's origin. */
export const toScreen = ([x, y], view = store.state.view) => [view.left + view.scale * x, view.top - view.scale * y];
export const toPlane = ([x, y], view = store.state.view) => [(x - view.left) / view.scale, (view.top - y) / view.scale];

/** The step that places are rounded to: a round number that is some 6 px on the screen. */
export const snapStep = () => round125(6 / store.state.view.scale);
export const gridStep = () => round125(70 / store.state.view.scale);

/** Round a place to the step, or to a hundredth of it. */
export function snap(place, free = false) {
  const step = snapStep() / (free ? 100 : 1);
  return place.map((one) => rounded(one, step));
}

/** Zoom by a factor about a place of the screen. */
export function zoom(factor, [x, y]) {
  const { scale, left, top } = store.state.view;
  const size = store.state.drawn?.size || 100;
  const next = Math.min(Math.max(scale * factor, 20 / size), 2e5 / size);
  store.put("view", { scale: next, left: x + ((left - x) * next) / scale, top: y + ((top - y) * next) / scale });
}

export function pan(dx, dy) {
  const { scale, left, top } = store.state.view;
  store.put("view", { scale, left: left + dx, top: top + dy });
}

/** Show places with some room about them in a box of the screen. */
export function fit(places, width, height) {
  const [xs, ys] = [0, 1].map((k) => places.map((place) => place[k]));
  const [low, high] = [[Math.min(...xs), Math.min(...ys)], [Math.max(...xs), Math.max(...ys)]];
  const room = Math.min(70, 0.1 * Math.min(width, height));
  const extent = Math.max(high[0] - low[0], high[1] - low[1], 1e-6);
  const wide = (width - 2 * room) / Math.max(high[0] - low[0], 0.05 * extent);
  const tall = (height - 2 * room) / Math.max(high[1] - low[1], 0.05 * extent);
  const scale = Math.min(wide, tall);
  const middle = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
  store.put("view", { scale, left: width / 2 - scale * middle[0], top: height / 2 + scale * middle[1] });
}
