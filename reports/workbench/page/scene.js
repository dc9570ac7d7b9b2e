/** Where everything stands that is drawn: in the case's pose or at an instant of its motion, with what is held by hand. */

import { tell } from "./server.js";
import { store, same } from "./store.js";
import { minus, plus, size, turned } from "./view.js";

export const radians = (degrees) => (degrees * Math.PI) / 180;
export const key = (link, point) => `${link}.${point}`;

/** Whether an instant of the motion is shown, whose places are not those of the case; it is told then. */
export function atInstant() {
  if (scene()?.still !== false) return false;
  tell("An instant of the motion is shown: use this pose, or go back to the case's pose, before you move anything.");
  return true;
}

/** Links, joints and loads with their places; null while nothing is known. */
export function scene({ drawn, motion, instant, held, loadCase } = store.state) {
  if (!drawn) return null;
  const at = new Map();
  const moved = instant !== null && motion?.points ? instant : null;
  for (const link of drawn.links) {
    for (const point of link.points) {
      const path = moved === null ? null : motion.points[key(link.name, point.name)];
      at.set(key(link.name, point.name), path?.[moved] ?? point.at);
    }
  }
  for (const one of held?.points ?? []) at.set(one, held.at);
  const links = drawn.links.map((link) => ({ ...link, ends: link.pieces, ...frame(link, at, moved, motion) }));
  const joints = drawn.joints.map((joint) => {
    const points = pointsOf(joint, drawn);
    const slotted = links.find((link) => link.name === joint.links[0]); // its slot turns with it
    const way = joint.way && turned(joint.way, radians((slotted?.direction ?? 0) - (slotted?.angle ?? 0)));
    return { ...joint, points, way, at: at.get(points.at(-1)) ?? joint.at };
  });
  const mine = (load) => load.load_case === loadCase || load.load_case === null;
  const loads = drawn.loads.filter((load) => mine(load) && moved === null).map((load) => ({
    ...load,
    at: at.get(key(load.link, load.point)) ?? load.at,
    vector: held?.load && same(held.load, load.path) ? held.vector : load.vector,
  }));
  return { drawn, at, links, joints, loads, springs: moved === null ? drawn.springs : [], still: moved === null,
    forces: (moved === null && drawn.forces?.[loadCase]) || { joints: {}, drive: null } };
}

/** Whether a pose lies beyond the motion that the case states; angles count from turn to turn. */
export function beyond({ kind, value, least, most }) {
  const turns = kind === "angle" ? [-360, 0, 360] : [0];
  return least !== null && !turns.some((turn) => value + turn > least - 1e-6 && value + turn < most + 1e-6);
}

/** Pieces, direction and outline (with its holes) of a link where it stands. */
function frame(link, at, moved, motion) {
  const pieces = link.pieces.map(([a, b]) => [at.get(key(link.name, a)), at.get(key(link.name, b))]);
  const direction = (moved === null ? null : motion.angles[link.name]?.[moved]) ?? link.angle;
  const [first] = link.points;
  if (!first) return { pieces, direction, origin: link.origin, rings: null };
  const origin = minus(at.get(key(link.name, first.name)), turned(first.local, radians(direction)));
  const place = (local) => plus(origin, turned(local, radians(direction)));
  const rings = link.outline ? [link.outline, ...(link.holes ?? [])].map((ring) => ring.map(place)) : null;
  return { pieces, direction, origin, rings };
}

/** Names "link.point" of the points that a joint holds together. */
function pointsOf(joint, drawn) {
  const near = 1e-6 * (drawn.size || 1);
  const found = [];
  for (const name of joint.links) {
    const link = drawn.links.find((one) => one.name === name);
    const close = (link?.points ?? []).filter((point) => size(minus(point.at, joint.at)) <= near);
    const named = link?.points.find((one) => one.name === joint.name); // where the loop does not close, not all are close
    const point = close.find((one) => one === named) ?? close[0] ?? (drawn.problem && named);
    if (point) found.push(key(name, point.name));
  }
  return found;
}

/** Points of links that no joint holds. */
export function freePoints({ links, joints, at }) {
  const held = new Set(joints.flatMap((joint) => joint.points));
  return links.flatMap((link) => link.points
    .filter((point) => !held.has(key(link.name, point.name)))
    .map((point) => ({ link: link.name, point: point.name, ground: link.ground, at: at.get(key(link.name, point.name)) })));
}

/** The place of a link's point given in the link's own frame, and the other way round. */
export const toLocal = (link, place) => turned(minus(place, link.origin), -radians(link.direction));
export const fromLocal = (link, local) => plus(link.origin, turned(local, radians(link.direction)));

/** The handle of the pose: beyond the far end of the link that the pose turns, or along the way of what slides. */
export function poseHandle({ links, joints, drawn }, pixel) {
  const pose = drawn.coordinate;
  if (!pose) return null;
  const sliding = joints.find((joint) => joint.name === pose.name && joint.way) ?? joints.find((joint) => joint.way && joint.links.includes(pose.name));
  if (pose.kind === "travel" && sliding) return { at: plus(sliding.at, sliding.way, 34 * pixel), way: sliding.way, pivot: sliding.at };
  const link = links.find((one) => one.name === pose.name);
  if (!link) return null;
  const grounded = (joint) => links.some((one) => one.ground && joint.links.includes(one.name));
  const mine = joints.filter((joint) => joint.links.includes(link.name));
  const pivot = (mine.find(grounded) ?? mine[0])?.at ?? link.origin;
  const ends = [...link.pieces.flat(), ...mine.map((joint) => joint.at)];
  const arms = ends.map((end) => minus(end, pivot)).sort((a, b) => size(b) - size(a));
  const reach = arms.length ? size(arms[0]) : 0;
  const way = reach > 0 ? arms[0].map((part) => part / reach) : turned([1, 0], radians(link.direction));
  const far = Math.max(reach, ...(link.rings?.[0] ?? []).map((one) => (one[0] - pivot[0]) * way[0] + (one[1] - pivot[1]) * way[1]));
  return { at: plus(pivot, way, far + 22 * pixel), way: null, pivot };
}
