// The colours of `colours.json`, which the 3D view and the HTML replay share.

export const palette = await (await fetch(new URL("colours.json", import.meta.url))).json();
