// What is written on the picture of a linkage: loads as arrows, the drive, names of links.

import { Vector3 } from "three";

const LOAD = "#b3261e";
const DRIVE = "#1b6e3c";
const SPRING = "#6b4fa0";
const LONGEST = 0.14; // arrow of the largest force, over the size of the linkage
const SHARES = [0.5, 0.35, 0.65, 0.2, 0.8]; // of a piece, at which its name may stand
const LEAST = 0.3; // the shortest arrow, over the longest

/**
 * Draw the marks of a linkage and write beside them, no text on another; what finds no room is left out.
 *
 * `at` takes a link and a place in its frame to the scene, `turned` a link to its direction.
 */
export function drawMarks(pen, stage, record, at, turned) {
  const taken = [];
  const write = (text, places, look = {}) => {
    const half = (look.bold ? 4.3 : 3.7) * text.length + 3;
    const found = places.find(({ x, y }) => taken.every((other) => Math.abs(other.x - x) > other.half + half || Math.abs(other.y - y) > 15));
    if (!found) return;
    taken.push({ ...found, half });
    stage.write(pen, text, found.x, found.y, { ...look, align: "center" });
  };
  drawSprings(pen, stage, record, at, write);
  drawDrive(pen, stage, record, at, write);
  drawLoads(pen, stage, record, at, turned, write);
  for (const { name, along: [x0, y0, x1, y1] } of record.links) {
    const places = SHARES.map((share) => stage.project(at(name, x0 + share * (x1 - x0), y0 + share * (y1 - y0))));
    write(name, [...places, ...around(places[0], 22)], { bold: true });
  }
}

/** Places beside a point of the picture. */
function around({ x, y }, far) {
  return [[1.5, -0.8], [1.5, 0.8], [-1.5, -0.8], [-1.5, 0.8], [0, 1.2], [0, -1.2]].map(([right, down]) => ({ x: x + right * far, y: y + down * far }));
}

/** The stated forces, as they act at the pose that is shown. */
function drawLoads(pen, stage, { loads, size }, at, turned, write) {
  const largest = Math.max(...loads.map(({ force }) => Math.hypot(...force)));
  for (const { link, place: [x, y], force, turns, text } of loads) {
    const angle = turns ? turned(link) : 0;
    const [c, s] = [Math.cos(angle), Math.sin(angle)];
    const strength = Math.hypot(...force);
    const length = LONGEST * size * Math.max(strength / largest, LEAST);
    const along = new Vector3(c * force[0] - s * force[1], s * force[0] + c * force[1], force[2]).multiplyScalar(length / strength);
    const tail = at(link, x, y);
    const [from, to] = [stage.project(tail), stage.project(tail.clone().add(along))];
    arrow(pen, from, to, LOAD);
    write(text, around(to, 22));
  }
}

/** The joint about which a link is driven, or at which it is pushed. */
function drawDrive(pen, stage, { drive }, at, write) {
  if (!drive) return;
  const { x, y } = stage.project(at(drive.link, ...drive.at));
  for (const [colour, width] of [["#ffffff", 5], [DRIVE, 2.5]]) {
    Object.assign(pen, { strokeStyle: colour, lineWidth: width });
    pen.beginPath();
    pen.arc(x, y, 15, -2.6, 1.4);
    pen.stroke();
  }
  const [c, s] = [Math.cos(1.4), Math.sin(1.4)];
  head(pen, { x: x + 15 * c, y: y + 15 * s }, Math.atan2(c, -s), DRIVE);
  write("drive", around({ x, y }, 27));
}

/** Springs and tendons, as lines between the points at which they are fastened. */
function drawSprings(pen, stage, { springs }, at, write) {
  for (const { name, kind, route } of springs) {
    const places = route.map(({ link, at: [x, y] }) => stage.project(at(link, x, y)));
    const line = { coil, spiral, cord: (all) => all }[kind](places);
    for (const [colour, width] of [["#ffffff", 4], [SPRING, 2]]) {
      Object.assign(pen, { strokeStyle: colour, lineWidth: width });
      pen.beginPath();
      line.forEach(({ x, y }, k) => (k ? pen.lineTo(x, y) : pen.moveTo(x, y)));
      pen.stroke();
    }
    write(name, around(line[Math.floor(line.length / 2)], 18).reverse());
  }
}

function coil([from, to]) {
  const [right, down] = [to.x - from.x, to.y - from.y];
  const size = Math.hypot(right, down) || 1;
  const inner = Array.from({ length: 13 }, (_, k) => {
    const share = 0.2 + (0.6 * k) / 12;
    const side = k % 12 === 0 ? 0 : k % 2 ? 7 : -7;
    return { x: from.x + share * right - (side * down) / size, y: from.y + share * down + (side * right) / size };
  });
  return [from, ...inner, to];
}

function spiral([{ x, y }]) {
  return Array.from({ length: 49 }, (_, k) => {
    const [turn, reach] = [(4 * Math.PI * k) / 48, 6 + (12 * k) / 48];
    return { x: x + reach * Math.cos(turn), y: y - reach * Math.sin(turn) };
  });
}

function arrow(pen, from, to, colour) {
  const angle = Math.atan2(to.y - from.y, to.x - from.x);
  if (Math.hypot(to.x - from.x, to.y - from.y) < 3) return; // along the line of sight
  Object.assign(pen, { strokeStyle: colour, lineWidth: 2.5 });
  pen.beginPath();
  pen.moveTo(from.x, from.y);
  pen.lineTo(to.x - 6 * Math.cos(angle), to.y - 6 * Math.sin(angle));
  pen.stroke();
  head(pen, to, angle, colour);
}

function head(pen, { x, y }, angle, colour) {
  pen.fillStyle = colour;
  pen.beginPath();
  pen.moveTo(x, y);
  for (const side of [-0.4, 0.4]) pen.lineTo(x - 12 * Math.cos(angle + side), y - 12 * Math.sin(angle + side));
  pen.fill();
}
