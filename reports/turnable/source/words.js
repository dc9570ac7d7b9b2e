// Numbers as the report writes them.

/** With some significant digits; with a power of ten outside 1e-4 to 1e5. */
export function number(value, digits = 4) {
  if (value === 0) return "0";
  const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
  const power = Number(exponent);
  if (power >= -4 && power < 5) return minus(value.toFixed(Math.max(digits - 1 - power, 0)));
  return minus(`${mantissa}·10${[...String(power)].map((sign) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(sign)]).join("")}`);
}

/** Without padding zeros. */
export function plain(value) {
  return minus(String(Number(value.toPrecision(6))));
}

/** With some decimals; zero has no sign. */
export function fixed(value, decimals) {
  const text = value.toFixed(decimals);
  return minus(Number(text) === 0 ? text.replace("-", "") : text);
}

function minus(text) {
  return text.replace("-", "−");
}

/** The largest 1, 2 or 5 times a power of ten that is not above a value. */
export function round(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return Math.max(...[1, 2, 5].map((step) => step * power).filter((step) => step <= value * (1 + 1e-9)));
}
