// What the user sets and the run keeps, such as a speed: what was set last is shown until the run has taken it, however long that takes.

import { computed, signal } from "../vendor/preact.js";
import { order } from "../server.js";
import { session } from "../store.js";

/**
 * Returns {value, set}: a signal with the value to be shown, and what sets it. One command at a time is under way; of what is set
 * meanwhile the newest is said next.
 *
 * @param told Returns the value that the run is known to have.
 * @param command Returns the command that sets a value.
 * @param send Sends it, and shows what is wrong.
 */
export function settable(told, command, send = order) {
  const wanted = signal(null); // {value}; null where the run has what was set
  let saying = false;

  async function say() {
    saying = true;
    const { id } = session.peek() ?? {};
    for (let said = null; said !== wanted.peek() && id === session.peek()?.id; ) {
      said = wanted.peek();
      await send(command(said.value));
    }
    saying = false;
    wanted.value = null;
  }

  function set(value) {
    wanted.value = { value };
    if (!saying) say();
  }

  return { value: computed(() => (wanted.value === null ? told() : wanted.value.value)), set };
}
