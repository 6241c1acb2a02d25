// Places the nodes of a graph in three columns: modules, buffers, productions. The same nodes are always at the same places.

const ROW = 26; // the height of a production [px]
const BOX = 46; // of a buffer or module [px]
const GAP = 8; // the least distance between two nodes [px]
const HEAD = 26; // the height of the columns' titles [px]
const SHARES = [0.25, 0.3, 0.27]; // of the width that a column has
const WIDEST = 320; // [px]

/** Returns the places of nodes of one height in a column, spread evenly: [{y, height}]. */
function spread(count, height, whole) {
  const room = (whole - count * height) / Math.max(1, count);
  return Array.from({ length: count }, (_, n) => ({ y: HEAD + room / 2 + n * (height + room), height }));
}

/**
 * Returns {width, height, nodes, heads}, with the place of each node by its id, {x, y, width, height}, and where the columns begin.
 *
 * @param width The width of the page's part [px].
 * @param columns The ids of modules, buffers and productions.
 */
export function placed(width, [modules, buffers, productions]) {
  const boxes = Math.max(modules.length, buffers.length);
  const whole = Math.max(productions.length * (ROW + 2), boxes * (BOX + GAP), 120);
  const widths = SHARES.map((share) => Math.min(WIDEST, Math.floor(share * width)));
  const between = Math.min(240, (width - widths.reduce((sum, one) => sum + one, 0)) / 2);
  const nodes = new Map();
  const heads = [];
  let x = 0;
  [[modules, BOX], [buffers, BOX], [productions, ROW]].forEach(([ids, height], n) => {
    heads.push(x);
    spread(ids.length, height, whole).forEach((place, m) => nodes.set(ids[m], { x, width: widths[n], ...place }));
    x += widths[n] + between;
  });
  return { width: x - between, height: HEAD + whole, nodes, heads };
}

/** Returns the path of an edge between two places, for SVG: from the facing sides, or past a column between them. `offset` moves its
 * ends up or down, so that edges of two kinds between the same nodes do not coincide [px]. */
export function edgePath(from, to, offset = 0) {
  const right = to.x > from.x;
  const [x1, x2] = right ? [from.x + from.width, to.x] : [from.x, to.x + to.width];
  const [y1, y2] = [from.y + from.height / 2 + offset, to.y + to.height / 2 + offset];
  const bend = (x2 - x1) / 2;
  return `M${x1.toFixed(1)},${y1.toFixed(1)}C${(x1 + bend).toFixed(1)},${y1.toFixed(1)} ${(x2 - bend).toFixed(1)},${y2.toFixed(1)} ${x2.toFixed(1)},${y2.toFixed(1)}`;
}
