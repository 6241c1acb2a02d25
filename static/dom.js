// Makes elements. Texts become text nodes: nothing that a model prints or raises is ever read as HTML.

export function el(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name in element && name !== "list") element[name] = value;
    else element.setAttribute(name, value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

export function place(id) {
  return document.getElementById(id);
}

/** Says a chunk as one reads it: places first, then slots. */
export function chunkText(chunk) {
  if (!chunk) return "(empty)";
  return Object.entries(chunk)
    .map(([slot, value]) => (/^\d+$/.test(slot) ? String(value) : `${slot}:${typeof value === "object" ? JSON.stringify(value) : value}`))
    .join("  ");
}
