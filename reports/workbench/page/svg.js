/** Elements of a drawing. Texts are set as text, never as markup. */

const SPACE = "http://www.w3.org/2000/svg";

/** Set attributes; null takes one away. */
export function set(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined) element.removeAttribute(name);
    else if (element.getAttribute(name) !== String(value)) element.setAttribute(name, value);
  }
  return element;
}

/** Make an element of SVG below a parent. */
export function draw(parent, tag, attributes = {}) {
  return parent.appendChild(set(document.createElementNS(SPACE, tag), attributes));
}

/** Make an element of HTML below a parent. */
export function add(parent, tag, attributes = {}, text = "") {
  const element = set(document.createElement(tag), attributes);
  element.textContent = text;
  return parent.appendChild(element);
}

/** A group whose elements stay between two drawings, by key: what has the focus or a finger keeps it. */
export class Group {
  constructor(parent, attributes = {}) {
    this.element = draw(parent, "g", attributes);
    this.kept = new Map();
    this.seen = new Set();
  }

  put(key, tag, attributes, text = null) {
    let element = this.kept.get(key);
    if (!element) this.kept.set(key, (element = draw(this.element, tag)));
    set(element, attributes);
    if (text !== null && element.textContent !== text) element.textContent = text;
    this.seen.add(key);
    return element;
  }

  /** Take away what was not drawn since this was last called, and put the rest in order; what has the focus stays. */
  end() {
    for (const [key, element] of this.kept) {
      if (this.seen.has(key)) continue;
      element.remove();
      this.kept.delete(key);
    }
    const order = [...this.seen].map((key) => this.kept.get(key));
    const apart = order.some((element, k) => element !== this.element.children[k]);
    if (apart && !this.element.contains(document.activeElement)) this.element.append(...order);
    this.seen.clear();
  }
}
