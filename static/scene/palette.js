// The colours of `palette.json`, which the 3D view and the HTML replay share.

export const palette = await (await fetch(new URL("palette.json", import.meta.url))).json();
