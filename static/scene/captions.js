// Texts at features of the 3D view, such as measured widths: HTML over the picture, which never covers another text or a head.

const GAP = 3; // between labels [px]
const LIFT = 10; // the height of a label above its point [px]
const STEPS = 40; // the number of positions tried for each
const AWAY = 26; // a label farther from its point than this has a line to it [px]

/** Returns the rectangle around positions in the picture [px]; null if one of them is behind the camera. */
function around(positions, { width, height }) {
  if (positions.some(({ depth }) => depth <= 0)) return null;
  const [xs, ys] = [positions.map(({ x }) => x * width), positions.map(({ y }) => y * height)];
  const [left, top] = [Math.min(...xs), Math.min(...ys)];
  return { left, top, width: Math.max(...xs) - left, height: Math.max(...ys) - top };
}

const overlap = (a, b) => a.left < b.left + b.width && b.left < a.left + a.width && a.top < b.top + b.height && b.top < a.top + a.height;

/**
 * Returns the rectangle of each label, or null if there is no room; earlier labels have priority.
 * @param wanted Labels: `x` and `y` of their points, `width` and `height` [px]; `about`: a rectangle that stays free if there is room.
 * @param blocked Rectangles that stay free.
 * @param size Width and height of the picture [px].
 */
export function placed(wanted, blocked, size) {
  const taken = [...blocked];
  return wanted.map(({ x, y, width, height, about }) => {
    if (x < 0 || x > size.width || y < 0 || y > size.height || width > size.width) return null;
    const inside = (left) => Math.max(0, Math.min(size.width - width, left));
    const centred = [inside(x - width / 2)];
    const free = (taken, lefts) => {
      for (let step = 0; step < STEPS; step++) {
        // Above its point, higher and higher; then below, lower and lower.
        for (const top of [y - LIFT - height - step * 6, y + LIFT + step * 6]) {
          if (top < 0 || top + height > size.height) continue;
          for (const left of lefts) {
            const box = { left: left - GAP, top: top - GAP, width: width + 2 * GAP, height: height + 2 * GAP };
            if (!taken.some((other) => overlap(box, other))) return { left, top, width, height };
          }
        }
      }
      return null;
    };
    // Beside what is in the way, but still above or below its point.
    const beside = () => taken.flatMap((other) => [other.left - GAP - width, other.left + other.width + GAP]).map(inside).filter((left) => left <= x && x <= left + width);
    const found = (about && free([...taken, about], centred)) ?? free(taken, centred) ?? free(taken, beside());
    if (found) taken.push(found);
    return found;
  });
}

export class Captions {
  constructor() {
    this.layer = document.createElement("div");
    this.layer.className = "scene-labels";
    document.body.append(this.layer);
    this.shown = [];
  }

  /**
   * @param labels The labels: `text`, `place` in the world, whether the agent attends to it (`chosen`), the ends of the measured `line`, if any.
   * @param heads Spheres that no label covers: x, y, z, radius.
   * @param covered Returns the rectangles of the picture that the page covers [px].
   */
  draw(labels, heads, camera, covered = () => []) {
    const size = { width: innerWidth, height: innerHeight };
    while (this.shown.length < labels.length) {
      const label = document.createElement("p");
      this.layer.append(label);
      this.shown.push({ label, text: "", width: 0, height: 0, style: "" });
    }
    const blocked = heads.map(([x, y, z, radius]) => {
      const at = camera.at([x, y, z]);
      const half = radius * camera.scaleAt(at.depth) * size.height;
      return at.depth > 0 ? { left: at.x * size.width - half, top: at.y * size.height - half, width: 2 * half, height: 2 * half } : null;
    });
    const wanted = labels.map(({ text, place, chosen, line }, n) => {
      const one = this.shown[n];
      if (one.text !== text) {
        one.text = one.label.textContent = text;
        ({ offsetWidth: one.width, offsetHeight: one.height } = one.label);
      }
      one.label.classList.toggle("chosen", chosen);
      const at = camera.at(place);
      return { x: at.depth > 0 ? at.x * size.width : -1, y: at.y * size.height, width: one.width, height: one.height, about: line && around(line.map((end) => camera.at(end)), size) };
    });
    const boxes = placed(wanted, [...blocked.filter(Boolean), ...(labels.length > 0 ? covered() : [])], size);
    this.shown.forEach((one, n) => {
      const box = boxes[n];
      let style = "visibility:hidden";
      if (box) {
        const { x, y } = wanted[n];
        const above = y - (box.top + box.height);
        const below = box.top - y;
        const line = above > AWAY ? `--line-top:100%;--line:${above.toFixed(0)}px;` : below > AWAY ? `--line-top:${-below.toFixed(0)}px;--line:${below.toFixed(0)}px;` : "";
        style = `transform:translate(${box.left.toFixed(1)}px,${box.top.toFixed(1)}px);${line}--line-left:${(x - box.left).toFixed(0)}px`;
      }
      if (one.style !== style) one.label.style = one.style = style;
    });
  }

  /** Paints the labels where they are now. */
  paint(context) {
    for (const { label, text } of this.shown) {
      const css = getComputedStyle(label);
      if (css.visibility === "hidden") continue;
      const { left, top, width, height } = label.getBoundingClientRect();
      const line = getComputedStyle(label, "::after");
      context.fillStyle = line.backgroundColor;
      context.fillRect(left + 1 + parseFloat(line.left), top + 1 + parseFloat(line.top), 1, parseFloat(line.height));
      context.beginPath();
      context.roundRect(left + 0.5, top + 0.5, width - 1, height - 1, parseFloat(css.borderTopLeftRadius));
      context.fillStyle = css.backgroundColor;
      context.fill();
      context.strokeStyle = css.borderTopColor;
      context.stroke();
      context.fillStyle = css.color;
      context.font = `${css.fontWeight} ${css.fontSize} ${css.fontFamily}`;
      context.textAlign = "center";
      context.textBaseline = "middle";
      const rows = text.split("\n");
      const high = parseFloat(css.lineHeight);
      rows.forEach((row, n) => context.fillText(row, left + width / 2, top + height / 2 + (n - (rows.length - 1) / 2) * high));
    }
  }
}
