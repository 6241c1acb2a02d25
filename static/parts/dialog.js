// Dialogs, based on the browser's own: they hold the focus, and Escape closes them.

import { Button } from "./button.js";
import { Problem } from "./problem.js";
import { notify } from "../store.js";
import { html, signal, useEffect, useId, useLayoutEffect, useRef, useSignal } from "../vendor/preact.js";

/** The open dialogs; the last one is on top. */
const open = signal([]);
let opened = 0;

/** Shows a dialog, on top of those that are open: `title`, `body` (made by `html`) and `actions` besides Cancel, [{text, kind?, value?, busy?}];
 * without any, it has the button Close. Returns the value of the chosen action, which is true by default; null if it is closed. With `ask`
 * {label, value, problem?, choices?} it has a text field, and the entered text is returned; with choices [{value, text}], {text, choice}. With
 * `check` it stays open until that function has checked the result of an action and returned true; the function shows itself what is wrong, and
 * meanwhile the action's button has the text `busy`. An Error that it throws is shown by `onError`; among the messages, if the user has closed
 * the dialog. */
export function dialog({ title, body = null, actions = [], ask, check, onError }) {
  opened += 1;
  const all = [{ text: actions.length > 0 ? "Cancel" : "Close", value: null }, ...actions.map((one) => ({ value: true, ...one }))];
  return new Promise((resolve) => (open.value = [...open.peek(), { number: opened, title, body, actions: all, ask, check, onError, resolve }]));
}

/** Asks for confirmation; returns whether the user agrees. */
export function confirmed(title, text, action) {
  return dialog({ title, body: html`<p>${text}</p>`, actions: [{ text: action, kind: "danger" }] }).then(Boolean);
}

/** Asks for a text; returns it, or null. `more` may have `problem`, why the text is not valid, and `choices`; see `dialog`. */
export function asked(title, label, value, action, more = {}) {
  return dialog({ title, ask: { label, value, ...more }, actions: [{ text: action, kind: "primary" }] });
}

/** Shows a `dialog` element above everything else, with the focus on its field that has `data-first`, if there is one. The browser's own
 * `autofocus` is blocked where the page is in a frame of another one, such as a notebook. */
export function showModal(box) {
  box.showModal();
  box.querySelector("[data-first=true]")?.focus();
}

/** The container of the dialogs. */
export function Dialogs() {
  return open.value.map((shown) => html`<${Dialog} key=${shown.number} shown=${shown} />`);
}

function Dialog({ shown }) {
  const box = useRef(null);
  const line = useRef(null);
  const id = useId();
  const checking = useSignal(false);
  // At once: the next key press is meant for the dialog.
  useLayoutEffect(() => {
    const own = box.current;
    showModal(own);
    const { activeElement } = document;
    if (activeElement.matches("input:not([type=radio], [type=checkbox])")) activeElement.select(); // typing replaces the selected text
    return () => own.close(); // which returns the focus, such as to a field of the dialog below
  }, []);
  const isChecking = checking.value;
  useEffect(() => {
    // From the button that was pressed to what is wrong; a field that the user is in by now keeps the focus.
    const wrong = isChecking || document.activeElement?.matches("input, select, textarea") ? null : box.current.querySelector("[aria-invalid=true]");
    wrong?.focus();
    wrong?.select();
  }, [isChecking]);

  const isOpen = () => open.peek().includes(shown);

  async function done(value) {
    if (value && isChecking) return;
    const result = shown.ask && value ? written() : value;
    if (value && shown.check) {
      checking.value = true;
      const fine = await checked(result);
      checking.value = false;
      if (!fine || !isOpen()) return;
    }
    open.value = open.peek().filter((other) => other !== shown);
    shown.resolve(result);
  }

  async function checked(result) {
    try {
      return await shown.check(result);
    } catch (error) {
      if (isOpen()) await shown.onError(error);
      else notify(`${shown.title}: ${error.message}`);
      return false;
    }
  }

  function written() {
    const text = line.current.value.trim();
    return shown.ask.choices ? { text, choice: box.current.querySelector("[name=choice]:checked").value } : text;
  }

  function press(event) {
    const first = shown.actions.find(({ kind }) => kind === "primary");
    if (event.key !== "Enter" || event.target.tagName !== "INPUT" || !first) return;
    event.preventDefault();
    done(first.value);
  }

  return html`<dialog ref=${box} aria-labelledby=${id} onClose=${() => isOpen() && done(null)} onKeyDown=${press}>
    <h2 id=${id}>${shown.title}</h2>
    ${shown.body}
    ${shown.ask
      ? html`<label class="field">
          ${shown.ask.label}
          <input ref=${line} data-first value=${shown.ask.value} spellcheck=${false} aria-invalid=${Boolean(shown.ask.problem)} aria-describedby="${id}-problem" />
        </label>
        <${Problem} id="${id}-problem" text=${shown.ask.problem} />`
      : null}
    ${shown.ask?.choices?.map(
      ({ value, text }, n) => html`<label class="choice"><input type="radio" name="choice" value=${value} defaultChecked=${n === 0} />${text}</label>`,
    )}
    <footer role="none">
      ${shown.actions.map(({ text, value, kind = "", busy = "checking …" }) => html`<${Button} class=${kind} disabled=${isChecking && Boolean(value)} onClick=${() => done(value)}>${isChecking && value ? busy : text}<//>`)}
    </footer>
  </dialog>`;
}
