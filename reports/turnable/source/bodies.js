// Bodies of the linkage from what reports/turnable/linkage.py packs: flat pieces between two heights, rods, pins.

import { ShapeUtils, Vector2 } from "three";
import { reals } from "./data.js";
import { Surface } from "./surface.js";

const SMOOTH = Math.cos(Math.PI / 6); // corners of an outline that turn by less are those of an arc
const ROUND = 28; // sides of what stands for a circle

/** Collects the nodes, triangles and sharp edges of a body. */
class Faces {
  nodes = [];
  triangles = [];
  edges = [];

  node(x, y, z) {
    this.nodes.push(x, y, z);
    return this.nodes.length / 3 - 1;
  }

  quad(a, b, c, d) {
    this.triangles.push(a, b, c, a, c, d);
  }

  /** The walls over a closed line, whose inside is on its left: flat where it has corners, smooth along arcs. */
  walls(ring, low, high) {
    const count = ring.length;
    const sides = ring.map((at, k) => direction(at, ring[(k + 1) % count]));
    const starts = [];
    const ends = [];
    ring.forEach(([x, y], k) => {
      const before = sides[(k + count - 1) % count];
      const pair = () => [this.node(x, y, low), this.node(x, y, high)];
      starts[k] = pair();
      if (before[0] * sides[k][0] + before[1] * sides[k][1] > SMOOTH) {
        ends[k] = starts[k];
      } else {
        ends[k] = pair();
        this.edges.push(...starts[k]);
      }
    });
    ring.forEach((_, k) => {
      const [a, b] = [starts[k], ends[(k + 1) % count]];
      this.quad(a[0], b[0], b[1], a[1]);
    });
  }

  /** A flat face, seen from above where `up`. */
  cap(rings, z, up) {
    const [contour, ...holes] = rings.map((ring) => ring.map(([x, y]) => new Vector2(x, y)));
    const triangles = ShapeUtils.triangulateShape(contour, holes);
    const nodes = [contour, ...holes].flatMap((ring) => this.line(ring.map(({ x, y }) => [x, y, z])));
    for (const [a, b, c] of triangles) this.triangles.push(nodes[a], ...(up ? [nodes[b], nodes[c]] : [nodes[c], nodes[b]]));
  }

  /** The nodes of a closed line, which is a sharp edge. */
  line(places) {
    const nodes = places.map((place) => this.node(...place));
    nodes.forEach((node, k) => this.edges.push(node, nodes[(k + 1) % nodes.length]));
    return nodes;
  }

  /** A round rod, or a tube: from a start along a direction, with two directions across it. */
  rod(start, along, across, radius, bore = 0) {
    const at = (far, size, k) => {
      const [c, s] = [Math.cos((2 * Math.PI * k) / ROUND), Math.sin((2 * Math.PI * k) / ROUND)];
      return [0, 1, 2].map((axis) => start[axis] + far * along[axis] + size * (c * across[0][axis] + s * across[1][axis]));
    };
    const turn = Array.from({ length: ROUND }, (_, k) => k);
    const side = (size, outward) => {
      const nodes = turn.map((k) => [this.node(...at(0, size, k)), this.node(...at(1, size, k))]);
      turn.forEach((k) => {
        const [a, b] = outward ? [nodes[k], nodes[(k + 1) % ROUND]] : [nodes[(k + 1) % ROUND], nodes[k]];
        this.quad(a[0], b[0], b[1], a[1]);
      });
    };
    side(radius, true);
    if (bore) side(bore, false);
    for (const far of [0, 1]) {
      const rim = this.line(turn.map((k) => at(far, radius, k)));
      const inner = bore ? this.line(turn.map((k) => at(far, bore, k))) : turn.map(() => rim[0]);
      turn.forEach((k) => {
        const next = (k + 1) % ROUND;
        this.quad(...(far ? [rim[k], rim[next], inner[next], inner[k]] : [rim[next], rim[k], inner[k], inner[next]]));
      });
    }
  }

  surface(look) {
    const kind = this.nodes.length / 3 > 65535 ? Uint32Array : Uint16Array;
    return new Surface(Float32Array.from(this.nodes), kind.from(this.triangles), kind.from(this.edges), look);
  }
}

function direction([x0, y0], [x1, y1]) {
  const size = Math.hypot(x1 - x0, y1 - y0) || 1;
  return [(x1 - x0) / size, (y1 - y0) / size];
}

/** The surface of a link's material about one mid-plane, in the link's frame. */
export function plateSurface(plate, look) {
  const faces = new Faces();
  const corners = plate.corners ? reals(plate.corners) : [];
  let first = 0;
  const rings = plate.counts.map((count) => {
    const ring = Array.from({ length: count }, (_, k) => [corners[2 * (first + k)], corners[2 * (first + k) + 1]]);
    first += count;
    return ring;
  });
  for (const [polygon, low, high] of plate.walls) polygon.forEach((ring) => faces.walls(rings[ring], low, high));
  for (const [polygon, z, up] of plate.caps) faces.cap(polygon.map((ring) => rings[ring]), z, up);
  for (const [x, y, z, angle, length, radius, bore] of plate.rods) {
    const [c, s] = [Math.cos(angle), Math.sin(angle)];
    faces.rod([x, y, z], [length * c, length * s, 0], [[-s, c, 0], [0, 0, 1]], radius, bore);
  }
  return faces.surface(look);
}

/** What stands for a link without a part: thin rods between its points, with a knob at each. */
export function lineSurface({ ends, points, z, radius }, look) {
  const faces = new Faces();
  for (const [x, y] of points) faces.rod([x, y, z - radius], [0, 0, 2 * radius], [[1, 0, 0], [0, 1, 0]], 2 * radius);
  for (const [x0, y0, x1, y1] of ends) {
    const [c, s] = direction([x0, y0], [x1, y1]);
    faces.rod([x0, y0, z], [x1 - x0, y1 - y0, 0], [[-s, c, 0], [0, 0, 1]], radius);
  }
  return faces.surface(look);
}

/** A pin, in the frame of the link with which it moves. */
export function pinSurface({ at: [x, y], low, high, radius }, look) {
  const faces = new Faces();
  faces.rod([x, y, low], [0, 0, Math.max(high - low, radius)], [[1, 0, 0], [0, 1, 0]], radius);
  return faces.surface(look);
}
