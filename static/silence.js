// Whether the workbench answers: as long as something waits for an answer and nothing is heard, it is asked whether it is there.

import { signal } from "./vendor/preact.js";

const PERIOD = 350; // [ms]
const MAX_PERIODS = 2; // without a sign after the question: about a second after a click

/** Whether something waits for an answer, and the workbench gives no sign: it was stopped, or is busy. */
export const silent = signal(false);

let waiting = 0;
let periods = 0; // since the last sign
let timer = 0;
let ask = () => false;

/** Sets how the workbench is asked whether it is there: a function that returns false if there is no connection. Any answer is a sign. */
export function askBy(question) {
  ask = question;
}

/** Called when something that the user has asked for, or a question of the page, was sent; returns the function to call once it is answered. */
export function awaited() {
  waiting += 1;
  timer ||= setInterval(look, PERIOD);
  return () => (waiting -= 1);
}

/** Called for each sign of the workbench, and when the connection to it ends. */
export function heard() {
  periods = 0;
  silent.value = false;
}

function look() {
  if (waiting === 0) {
    clearInterval(timer);
    timer = 0;
    heard();
  } else if (periods > 0 || ask()) {
    periods += 1; // periods, not milliseconds, as a page that was busy itself looks before it hears what has arrived
    silent.value = periods > MAX_PERIODS;
  }
}
