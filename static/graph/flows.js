// What flows between the productions, buffers and modules of a run, as its events show it.

import { agentOf, agentsOf, productionKey } from "../inspector/agents.js";
import { eventCount, events, history, state } from "../store.js";

const ENDS = new Set(["conflict", "fire", "initialize"]); // what follows is no longer the work of the production that has fired
const OWN = new Set(["buffer", "state", "request", "productions", "select", "add", "output"]); // these say nothing of where a buffer's content comes from

/** What an agent does at a moment. */
class Doing {
  /** The production that has just fired, as [key, time]. */
  fired = null;
  /** Whether it is being initialised. */
  begins = false;

  constructor() {
    this.group(-1);
  }

  /** Begins another group of events that belong together: the modules that are at work at a time, and the buffers filled then. */
  group(time) {
    Object.assign(this, { time, modules: new Set(), buffers: new Set() });
  }
}

/** What is known of a run. */
class Known {
  #writes = new Map(); // by production: the buffers that it has filled, and the modules that it has asked
  #clears = new Map(); // by production: the buffers that were emptied as it fired
  /** By module: the paths of the buffers that it has filled. */
  feeds = new Map();
  #next = 0;
  #doing = new Map(); // by agent

  /** Takes in the new events of a list. */
  take({ list, first }, agents) {
    for (let n = Math.max(0, this.#next - first); n < list.length; n += 1) this.#one(list[n], agentOf(list[n][1], agents));
    this.#next = first + list.length;
  }

  #one([time, source, kind, data], agent) {
    if (!this.#doing.has(agent)) this.#doing.set(agent, new Doing());
    const doing = this.#doing.get(agent);
    if (doing.fired && time !== doing.fired[1]) doing.fired = null;
    if (ENDS.has(kind)) {
      doing.begins = kind === "initialize";
      doing.fired = kind === "fire" ? [productionKey(source, data.production), time] : null;
      doing.group(time);
      return;
    }
    if (doing.begins) return;
    if (doing.fired) {
      if (kind === "request" || kind === "buffer") add(kind === "buffer" && data.chunk === null ? this.#clears : this.#writes, doing.fired[0], source);
      return;
    }
    if (time !== doing.time) doing.group(time);
    if (kind === "buffer" && data.chunk !== null) doing.buffers.add(source);
    else if (!OWN.has(kind)) doing.modules.add(source);
    if (doing.modules.size === 1) for (const buffer of doing.buffers) add(this.feeds, [...doing.modules][0], buffer);
  }

  /** Returns the paths of the buffers that a production (`productionKey`) has changed, and of the modules that it has asked. A module that is
   * asked may empty the buffer that it will fill: that is not the production's own work. */
  changedBy(production) {
    const written = this.#writes.get(production) ?? new Set();
    const own = [...(this.#clears.get(production) ?? [])].filter((path) => ![...written].some((module) => this.feeds.get(module)?.has(path)));
    return new Set([...written, ...own]);
  }
}

function add(map, key, value) {
  if (!map.has(key)) map.set(key, new Set());
  map.get(key).add(value);
}

let known = new Known();
let of = "";
let begin = 0; // the number of the first event

/** Returns what is known of the run that is shown. */
export function flows() {
  const { first } = events.value;
  if (of !== history.value || first < begin) {
    known = new Known();
    of = history.value;
  }
  begin = first;
  known.take(events.value, agentsOf(state.value?.parts));
  return known;
}

/** Returns what has happened within the last tick up to the present moment: {fired, answered}, the production that has fired, as `productionKey`,
 * and the modules that have filled buffers; by system, if `belongs` says that a source belongs to it. */
export function justNow(period, belongs) {
  const { list, first } = events.value;
  const now = eventCount.value;
  const since = Math.round(((state.value?.time ?? 0) - period) * 1e6);
  let fired = null;
  const answered = new Set();
  for (let n = Math.min(list.length, now - first) - 1; n >= 0; n -= 1) {
    const [time, source, kind, data] = list[n];
    if (time <= since) break;
    if (!belongs(source)) continue;
    if (kind === "fire") fired ??= productionKey(source, data.production);
    else if (!OWN.has(kind) && !ENDS.has(kind)) answered.add(source);
  }
  return { fired, answered };
}
