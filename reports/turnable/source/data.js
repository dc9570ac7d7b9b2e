// Arrays of a data block: base64 of little-endian integers, as reports/turnable/pack.py packs them.

function bytes(text) {
  return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer;
}

/** Rows of real numbers; `low` and `high` of each column stand for 0 and 65535. */
export function reals({ low, high, data }) {
  const steps = new Uint16Array(bytes(data));
  const columns = low.length;
  const size = high.map((value, column) => (value - low[column]) / 65535);
  return Float32Array.from(steps, (step, place) => low[place % columns] + step * size[place % columns]);
}

/** Whole numbers of 16 or 32 bits. */
export function indices({ bits, data }) {
  return bits === 16 ? new Uint16Array(bytes(data)) : new Uint32Array(bytes(data));
}

/** Places among the 256 colours of a legend. */
export function shades(text) {
  return new Uint8Array(bytes(text));
}
