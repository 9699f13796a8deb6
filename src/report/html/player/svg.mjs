// Elements, text and numbers. Text is only ever set as text.

const SVG = "http://www.w3.org/2000/svg";

/**
 * An SVG element.
 * @param {string} name @param {Record<string, string | number>} [attributes] @param {(Node | string)[]} [children]
 * @returns {any}
 */
export function shape(name, attributes = {}, children = []) {
  return filled(document.createElementNS(SVG, name), attributes, children);
}

/**
 * An HTML element.
 * @param {string} name @param {Record<string, string | number>} [attributes] @param {(Node | string)[]} [children]
 * @returns {any}
 */
export function element(name, attributes = {}, children = []) {
  return filled(document.createElement(name), attributes, children);
}

function filled(node, attributes, children) {
  setAll(node, attributes);
  node.append(...children);
  return node;
}

/** Sets attributes. @param {Element} node @param {Record<string, string | number>} attributes */
export function setAll(node, attributes) {
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, String(value));
}

/** Pixels beyond which nothing is drawn: browsers lose a path with larger coordinates. */
const FAR = 1e6;

/** A pixel coordinate. @param {number} value */
export const px = (value) =>
  Number.isFinite(value) ? Math.round(Math.min(Math.max(value, -FAR), FAR) * 100) / 100 : 0;

/** Path data through pixel points; null breaks the line. @param {([number, number] | null)[]} points */
export function pathThrough(points) {
  let data = "";
  let pen = false;
  for (const point of points) {
    if (point) data += `${pen ? "L" : "M"}${px(point[0])} ${px(point[1])}`;
    pen = point !== null;
  }
  return data;
}

/** A number with so many significant digits, without an exponent where it is of a usual size. */
export function figure(value, digits = 4) {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.floor(Math.log10(Math.abs(value)));
  if (size < -4 || size > 6) return minus(value.toExponential(digits - 1));
  return minus(value.toFixed(Math.max(0, Math.min(12, digits - 1 - size))));
}

/** With a true minus sign. @param {string} text */
export const minus = (text) => text.replace("-", "−");

/** The largest of 1, 2, 5 times a power of ten that is at most `length`. @param {number} length */
export function roundLength(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  return [5, 2, 1].map((m) => m * power).find((round) => round <= length) ?? power;
}

/** Round steps for an axis from low to high, about `count` of them. @returns {number[]} */
export function ticks(low, high, count) {
  const span = high - low;
  if (!(span > 0) || !Number.isFinite(span)) return [low];
  const raw = span / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= raw * 0.8) ?? 10 * power;
  const list = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * span; i += 1) list.push(i * step + 0);
  return list;
}

/** Ticks of an angle, degrees: quarters of a turn and their parts. */
export function angleTicks(low, high, count) {
  const step = [1, 2, 5, 10, 15, 30, 45, 60, 90, 180].find((s) => (high - low) / s <= count) ?? 180;
  const list = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9; i += 1) list.push(i * step + 0);
  return list;
}

/** The numbers of ticks as short as they tell the steps apart. @param {number[]} values */
export function tickTexts(values) {
  const step = values.length > 1 ? Math.abs(values[1] - values[0]) : Math.abs(values[0]) || 1;
  const largest = Math.max(...values.map(Math.abs), step);
  if (largest >= 1e6 || largest < 1e-4)
    return values.map((v) => (v === 0 ? "0" : minus(Number(v.toPrecision(3)).toExponential())));
  const decimals = Math.max(0, Math.min(10, -Math.floor(Math.log10(step) + 1e-9)));
  return values.map((v) => minus((Math.abs(v) < step * 1e-6 ? 0 : v).toFixed(decimals)));
}
