// What the user is told: errors with their lines, warnings, what the model's process prints.

import { el } from "../dom.js";
import { store, watch } from "../store.js";

export function log(root) {
  const list = el("div");
  root.append(el("h2", {}, "Messages"), list);
  watch(["notices"], () => {
    list.replaceChildren(
      ...store.notices.toReversed().map(({ level, text, file, line, detail }) =>
        el(
          "div",
          { className: level },
          `${file ? `${file}:${line}: ` : ""}${text}`,
          detail && detail.trim() !== text ? el("details", {}, el("summary", {}, "where"), el("pre", {}, detail)) : null,
        ),
      ),
    );
  });
}
