// The colours of `palette.json`, which the 3D view, the retina and the HTML replay share.

export const palette = await (await fetch(new URL("palette.json", import.meta.url))).json();

/** Returns the red, green and blue of a colour such as `#5b7fa6`, 0 to 255. */
export function channels(hex) {
  return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
}

/** Returns the colour of a label of an eye, the same on the retina and on the edges in the scene. */
export function labelColour(label) {
  return palette.labels[(label + palette.labels.length - 1) % palette.labels.length];
}
