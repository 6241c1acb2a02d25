// A value that the user sets and the run confirms, such as a speed: the latest input is shown until the run has accepted it.

import { computed, signal } from "../vendor/preact.js";
import { unsent, sendCommand } from "../server.js";
import { session } from "../store.js";

/**
 * Returns {value, set}: a signal with the value to show, and the function that sets it. One command at a time is sent; of the
 * values set meanwhile, the newest is sent next: when that one is answered, or before any other command.
 *
 * @param reported Returns the value last reported by the run.
 * @param command Returns the command that sets a value.
 * @param send Sends it, and shows errors.
 */
export function optimistic(reported, command, send = sendCommand) {
  const wanted = signal(null); // {value}; null if the run has confirmed the value
  let [sent, answer] = [null, null]; // the last value that was sent, and the promise of its answer

  function sendNewest() {
    unsent.delete(sendNewest);
    if (sent === wanted.peek()) return;
    sent = wanted.peek();
    answer = send(command(sent.value));
  }

  async function sendWanted() {
    const { id } = session.peek() ?? {};
    for (let last = null; id === session.peek()?.id && (last !== answer || sent !== wanted.peek()); ) {
      sendNewest();
      last = answer;
      await last;
    }
    unsent.delete(sendNewest);
    wanted.value = sent = answer = null;
  }

  function set(value) {
    const sending = wanted.peek() !== null;
    wanted.value = { value };
    if (sending) unsent.add(sendNewest);
    else sendWanted();
  }

  return { value: computed(() => (wanted.value === null ? reported() : wanted.value.value)), set };
}
