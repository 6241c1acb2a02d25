// The seed of the run, as a field: Enter runs the model from its start with the entered seed.

import { html, useSignal } from "../vendor/preact.js";
import { sendCommand } from "../server.js";
import { session, shownRun } from "../store.js";

const MAX_SEED = 2n ** 63n - 1n;

/** Returns why a text is not a valid seed; null if it is one. */
export function seedProblem(text) {
  const written = text.trim();
  if (!/^\d+$/.test(written)) return `the seed must be a whole number >= 0 (got «${written.slice(0, 40)}»)`;
  return written.length > 19 || BigInt(written) > MAX_SEED ? `a seed is at most ${MAX_SEED} (got ${written.slice(0, 40)})` : null;
}

export function SeedField() {
  const draft = useSignal(null); // the text being typed: {of, text}
  const { seed } = session.value ?? {};
  const known = seed === null || seed === undefined ? "" : String(seed);
  const of = shownRun.value;
  const mine = draft.value?.of === of ? draft.value : null; // ignores a text typed for another run
  const text = mine?.text ?? known;
  const problem = mine?.submitted ? seedProblem(text) : null;
  // The largest seed is too large for a JavaScript number: it is sent as text.
  function press(event) {
    if (event.key === "Escape") draft.value = null;
    if (event.key !== "Enter") return;
    event.preventDefault();
    const wanted = event.currentTarget.value;
    draft.value = { of, text: wanted, submitted: true };
    if (seedProblem(wanted) !== null) return;
    sendCommand({ type: "restart", seed: wanted.trim() });
    event.currentTarget.blur();
  }
  return html`<label class="seed-field ${mine && text !== known ? "waits" : ""}" title="The seed of the run. Enter restarts with this seed">
    <input
      aria-label="Seed"
      inputmode="numeric"
      autocomplete="off"
      spellcheck=${false}
      disabled=${!session.value}
      value=${text}
      aria-invalid=${Boolean(problem)}
      onFocus=${(event) => event.currentTarget.select()}
      onInput=${(event) => (draft.value = { of, text: event.currentTarget.value, submitted: false })}
      onKeyDown=${press}
      onBlur=${() => (draft.value = null)}
    />
    ${problem ? html`<span class="seed-problem bad" role="alert">${problem}</span>` : null}
  </label>`;
}
