"use strict";
// The list of events: only the rows that are in sight are in the page.

const ROW = 22;

class Events {
  constructor(events, seek, end) {
    this.rows = events.rows;
    this.kinds = events.kinds; // by kind: its title, and whether it is shown without all details
    this.seek = seek;
    this.end = end;
    this.list = document.getElementById("events");
    this.now = -1;
    this.made = new Map(); // by number, the rows that are in the page: one that has the keyboard's focus keeps it
    this.more = events.more;
    this.filter();
    this.list.addEventListener("scroll", () => this.show());
    new ResizeObserver(() => this.show()).observe(this.list);
    for (const id of ["filter", "details"])
      document.getElementById(id).addEventListener("input", () => {
        this.filter();
        this.mark(this.time, true);
      });
  }

  filter() {
    const words = document.getElementById("filter").value.toLowerCase().split(/\s+/).filter(Boolean);
    const details = document.getElementById("details").checked;
    const fits = ([, source, kind, text]) => words.every((word) => `${source} ${kind} ${this.kinds[kind][0]} ${text}`.toLowerCase().includes(word));
    for (const row of this.made.values()) row.remove();
    this.made.clear();
    this.shown = this.rows.filter((row) => (details || this.kinds[row[2]][1]) && fits(row));
    document.getElementById("height").style.height = `${this.shown.length * ROW}px`;
    this.showCount();
    this.show();
  }

  showCount() {
    const left = this.more ? `; ${this.more} more are left out` : "";
    document.getElementById("count").textContent = `${this.shown.length} of ${this.rows.length} events${left}`;
  }

  // Marks what has happened up to a time, and brings it into sight.
  mark(time, anyway) {
    this.time = time;
    let low = 0, high = this.shown.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.shown[middle][0] <= time + 1e-6) low = middle + 1;
      else high = middle;
    }
    if (low - 1 === this.now && !anyway) return;
    this.now = low - 1;
    this.present = this.shown[this.now]?.[0];
    const at = this.now * ROW, list = this.list;
    if (at < list.scrollTop || at > list.scrollTop + list.clientHeight - 2 * ROW) list.scrollTop = Math.max(0, at - list.clientHeight / 2);
    this.show();
  }

  show() {
    const list = this.list, first = Math.max(0, Math.floor(list.scrollTop / ROW) - 5);
    const last = Math.min(this.shown.length, first + Math.ceil(list.clientHeight / ROW) + 10);
    for (const [n, row] of this.made)
      if (n < first || n >= last) {
        row.remove();
        this.made.delete(n);
      }
    let next = document.getElementById("height").nextSibling;
    for (let n = first; n < last; n++) {
      const [time, , kind] = this.shown[n], row = this.made.get(n) || this.row(n);
      row.className = `event${kind === "fire" ? " fire" : ""}${n > this.now ? " ahead" : time === this.present ? " now" : ""}`;
      if (row === next) next = row.nextSibling;
      else list.insertBefore(row, next);
      this.made.set(n, row);
    }
  }

  row(number) {
    const [time, source, kind, text] = this.shown[number];
    const row = document.createElement("button");
    row.type = "button";
    row.style.top = `${number * ROW}px`;
    const when = document.createElement("time"), who = document.createElement("span"), what = document.createElement("b");
    when.textContent = plainTime(time, 3, this.end);
    who.textContent = `${source} ${this.kinds[kind][0]} `;
    what.textContent = text;
    row.append(when, who, what);
    row.title = `${source} ${kind}: ${text}`;
    row.addEventListener("click", () => this.seek(time));
    return row;
  }
}
