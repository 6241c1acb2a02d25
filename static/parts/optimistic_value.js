// A value that the user sets and the run confirms, such as a speed: the latest input is shown until the run has accepted it.

import { computed, signal } from "../vendor/preact.js";
import { order } from "../server.js";
import { session } from "../store.js";

/**
 * Returns {value, set}: a signal with the value to show, and the function that sets it. One command at a time is sent; of the
 * values set meanwhile, the newest is sent next.
 *
 * @param reported Returns the value last reported by the run.
 * @param command Returns the command that sets a value.
 * @param send Sends it, and shows errors.
 */
export function optimistic(reported, command, send = order) {
  const wanted = signal(null); // {value}; null if the run has confirmed the value
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

  return { value: computed(() => (wanted.value === null ? reported() : wanted.value.value)), set };
}
