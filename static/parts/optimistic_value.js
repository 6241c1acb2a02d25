// A value that the user sets and the run confirms, such as a speed: the latest input is shown until the run has accepted it.

import { computed, signal } from "../vendor/preact.js";
import { heldBack, order } from "../server.js";
import { session } from "../store.js";

/**
 * Returns {value, set}: a signal with the value to show, and the function that sets it. One command at a time is sent; of the
 * values set meanwhile, the newest is sent next: when that one is answered, or before any other command.
 *
 * @param reported Returns the value last reported by the run.
 * @param command Returns the command that sets a value.
 * @param send Sends it, and shows errors.
 */
export function optimistic(reported, command, send = order) {
  const wanted = signal(null); // {value}; null if the run has confirmed the value
  let [said, answer] = [null, null]; // the last value that was sent, and the promise of its answer

  function sayNewest() {
    heldBack.delete(sayNewest);
    if (said === wanted.peek()) return;
    said = wanted.peek();
    answer = send(command(said.value));
  }

  async function say() {
    const { id } = session.peek() ?? {};
    for (let last = null; id === session.peek()?.id && (last !== answer || said !== wanted.peek()); ) {
      sayNewest();
      last = answer;
      await last;
    }
    heldBack.delete(sayNewest);
    wanted.value = said = answer = null;
  }

  function set(value) {
    const saying = wanted.peek() !== null;
    wanted.value = { value };
    if (saying) heldBack.add(sayNewest);
    else say();
  }

  return { value: computed(() => (wanted.value === null ? reported() : wanted.value.value)), set };
}
