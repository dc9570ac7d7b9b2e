// The surface of a body: coloured by a value at its nodes, deformed by a displacement, with its sharp edges as lines.

import {
  BufferAttribute, BufferGeometry, ClampToEdgeWrapping, Color, DataTexture, Group, LinearFilter, LineBasicMaterial,
  LineSegments, Matrix4, Mesh, RGBAFormat, ShaderMaterial, Vector3,
} from "three";

const VERTEX = `
attribute float value;
varying float share;
varying vec3 across;
void main() {
  share = value;
  across = normalMatrix * normal;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;
const FRAGMENT = `
uniform sampler2D colours;
uniform vec3 plain;
uniform float coloured;
varying float share;
varying vec3 across;
void main() {
  float light = min(0.62 + 0.42 * abs(normalize(across).z), 1.0);
  float place = (clamp(share, 0.0, 1.0) * 255.0 + 0.5) / 256.0;
  vec3 colour = mix(plain, texture2D(colours, vec2(place, 0.5)).rgb, coloured);
  gl_FragColor = vec4(colour * light, 1.0);
}`;

/** A texture of 256 colours from "rrggbb" texts, the same distance apart. */
export function colourTexture(table) {
  const texels = new Uint8Array(1024).fill(255);
  colours(table).forEach((colour, place) => texels.set(colour, 4 * place));
  const texture = new DataTexture(texels, 256, 1, RGBAFormat);
  Object.assign(texture, { magFilter: LinearFilter, minFilter: LinearFilter, wrapS: ClampToEdgeWrapping, needsUpdate: true });
  return texture;
}

/** The 256 colours themselves, [red, green, blue] from 0 to 255. */
export function colours(table) {
  const fixed = table.map((text) => [0, 2, 4].map((start) => parseInt(text.slice(start, start + 2), 16)));
  return Array.from({ length: 256 }, (_, step) => {
    const place = (step / 255) * (fixed.length - 1);
    const before = Math.min(Math.floor(place), fixed.length - 2);
    return fixed[before].map((from, channel) => Math.round(from + (place - before) * (fixed[before + 1][channel] - from)));
  });
}

/** Triangles of faces of three or six nodes; six are three corners and the middles of the edges 01, 12 and 02. */
export function trianglesOf(faces, perFace) {
  if (perFace === 3) return faces;
  const split = [0, 3, 5, 3, 1, 4, 5, 4, 2, 3, 4, 5];
  const found = new faces.constructor(2 * faces.length);
  for (let face = 0; face < faces.length / 6; face += 1) {
    for (let k = 0; k < 12; k += 1) found[12 * face + k] = faces[6 * face + split[k]];
  }
  return found;
}

export class Surface {
  /**
   * @param {Float32Array} rest positions of the nodes, undeformed [mm]
   * @param {Uint16Array|Uint32Array} triangles nodes of each
   * @param {Uint16Array|Uint32Array} edges pairs of nodes along sharp edges
   * @param {{colours?: DataTexture, plain?: string}} look colours of the values, or one colour
   */
  constructor(rest, triangles, edges, { colours: texture = null, plain = "#9fb1c1" } = {}) {
    this.rest = rest;
    this.triangles = triangles;
    this.values = null;
    const position = new BufferAttribute(rest.slice(), 3);
    this.body = new BufferGeometry();
    this.body.setAttribute("position", position);
    this.body.setAttribute("value", new BufferAttribute(new Float32Array(rest.length / 3), 1));
    this.body.setIndex(new BufferAttribute(triangles, 1));
    this.lines = new BufferGeometry();
    this.lines.setAttribute("position", position);
    this.lines.setIndex(new BufferAttribute(edges, 1));
    const material = new ShaderMaterial({ vertexShader: VERTEX, fragmentShader: FRAGMENT, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 2,
      uniforms: { colours: { value: texture }, plain: { value: new Color(plain) }, coloured: { value: texture ? 1 : 0 } } });
    this.mesh = new Mesh(this.body, material);
    this.outline = new LineSegments(this.lines, new LineBasicMaterial({ color: 0x1c2733, transparent: true, opacity: 0.55 }));
    this.group = new Group();
    this.group.add(this.mesh, this.outline);
    this.group.traverse((part) => Object.assign(part, { frustumCulled: false }));
    this.body.computeVertexNormals();
  }

  /** The sharp edges of the undeformed body, as grey lines. */
  still() {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(this.rest, 3));
    geometry.setIndex(this.lines.index);
    const made = new LineSegments(geometry, new LineBasicMaterial({ color: 0x8b98a5 }));
    made.frustumCulled = false;
    return made;
  }

  /** Move the nodes by a displacement times a factor. */
  deform(displacement, factor) {
    const position = this.body.attributes.position;
    for (let k = 0; k < this.rest.length; k += 1) position.array[k] = this.rest[k] + factor * displacement[k];
    position.needsUpdate = true;
    this.body.computeVertexNormals();
  }

  /** Colour the nodes by values; `low` and `high` have the first and the last colour. */
  colour(values, low, high) {
    this.values = values;
    const share = this.body.attributes.value;
    for (let k = 0; k < values.length; k += 1) share.array[k] = (values[k] - low) / (high - low);
    share.needsUpdate = true;
  }

  /** Where a node is now [mm], in the axes of the scene. */
  node(number) {
    this.group.updateWorldMatrix(true, false);
    return new Vector3().fromBufferAttribute(this.body.attributes.position, number).applyMatrix4(this.group.matrixWorld);
  }

  /** Whether a ray through a node meets it first, or what lies less than a thousandth of the body before it. */
  seen(node, ray) {
    const found = this.pick(ray);
    if (!found) return true; // on the outline
    const before = this.node(node).sub(ray.origin).dot(ray.direction) - found.distance;
    if (!this.body.boundingSphere) this.body.computeBoundingSphere();
    return found.node === node || before < 1e-3 * this.body.boundingSphere.radius;
  }

  /** A direction from which a node is seen, as near to its normal and to the viewer's direction as may be; null if there is none. */
  freeDirection(node, toward) {
    this.group.updateWorldMatrix(true, false);
    const normal = new Vector3().fromBufferAttribute(this.body.attributes.normal, node).transformDirection(this.group.matrixWorld);
    this.body.computeBoundingSphere();
    const [at, away] = [this.node(node), 4 * this.body.boundingSphere.radius];
    const round = Array.from({ length: 150 }, (_, k) => new Vector3().setFromSphericalCoords(1, Math.acos(1 - (k + 0.5) / 75), k * Math.PI * (1 + Math.sqrt(5))));
    const facing = (one) => one.dot(normal);
    return [toward, ...round].filter((one) => facing(one) > 0.25)
      .sort((one, other) => facing(other) + 0.4 * other.dot(toward) - facing(one) - 0.4 * one.dot(toward))
      .find((one) => this.seen(node, { origin: at.clone().addScaledVector(one, away), direction: one.clone().negate() })) ?? null;
  }

  /**
   * The first triangle that a ray meets: { distance, node } with the nearest of its nodes, or null.
   *
   * Möller & Trumbore, J. Graphics Tools 2 (1997) 21-28.
   */
  pick({ origin, direction }) {
    this.group.updateWorldMatrix(true, false);
    const back = new Matrix4().copy(this.group.matrixWorld).invert();
    const start = origin.clone().applyMatrix4(back).toArray();
    const along = direction.clone().transformDirection(back).toArray();
    const at = this.body.attributes.position.array;
    let found = null;
    for (let k = 0; k < this.triangles.length; k += 3) {
      const [a, b, c] = [3 * this.triangles[k], 3 * this.triangles[k + 1], 3 * this.triangles[k + 2]];
      const [abx, aby, abz] = [at[b] - at[a], at[b + 1] - at[a + 1], at[b + 2] - at[a + 2]];
      const [acx, acy, acz] = [at[c] - at[a], at[c + 1] - at[a + 1], at[c + 2] - at[a + 2]];
      const [px, py, pz] = [along[1] * acz - along[2] * acy, along[2] * acx - along[0] * acz, along[0] * acy - along[1] * acx];
      const determinant = abx * px + aby * py + abz * pz;
      if (Math.abs(determinant) < 1e-14) continue;
      const [sx, sy, sz] = [start[0] - at[a], start[1] - at[a + 1], start[2] - at[a + 2]];
      const u = (sx * px + sy * py + sz * pz) / determinant;
      if (u < 0 || u > 1) continue;
      const [qx, qy, qz] = [sy * abz - sz * aby, sz * abx - sx * abz, sx * aby - sy * abx];
      const v = (along[0] * qx + along[1] * qy + along[2] * qz) / determinant;
      if (v < 0 || u + v > 1) continue;
      const distance = (acx * qx + acy * qy + acz * qz) / determinant;
      if (distance > 0 && (!found || distance < found.distance)) {
        found = { distance, triangle: k, at: [0, 1, 2].map((axis) => start[axis] + distance * along[axis]) };
      }
    }
    if (!found) return null;
    const corners = Array.from(this.triangles.subarray(found.triangle, found.triangle + 3));
    const away = (node) => Math.hypot(...[0, 1, 2].map((axis) => at[3 * node + axis] - found.at[axis]));
    return { distance: found.distance, node: corners.reduce((best, node) => (away(node) < away(best) ? node : best)) };
  }
}
