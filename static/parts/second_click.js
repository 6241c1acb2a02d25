// A double click is meant for what its first click has hit. If that click removes it, such as a dialog or a list, the second one would hit
// something else that lies there then: it is ignored.

const CONTROLS = "button, a, label, input, select, tr, [role=option]";
const SOON = 500; // the longest time between the two clicks [ms]
const NEAR = 5; // the largest distance between them [px]

/** What was pressed last: the control, its kind, the elements that contained it, where and when; null for nothing. */
let last = null;
let isIgnored = false; // whether the present press is ignored

const kindOf = ({ tagName, className }) => `${tagName} ${className}`;
const isGone = (control) => !control.isConnected || !control.checkVisibility();

/** Whether an element is the same control of the next entry of a list, which is where that of an entry was that is gone. */
function isNext(target) {
  const list = last.parents.find((parent) => parent.isConnected);
  const other = target.closest(CONTROLS);
  return list !== document.body && list?.contains(target) && other !== null && kindOf(other) === last.kind;
}

function isSecond({ clientX, clientY, timeStamp }) {
  return last !== null && timeStamp - last.at < SOON && Math.hypot(clientX - last.x, clientY - last.y) < NEAR;
}

function parentsOf({ parentElement }) {
  return parentElement === null ? [] : [parentElement, ...parentsOf(parentElement)];
}

function stop(event) {
  event.preventDefault();
  event.stopPropagation();
}

function press(event) {
  isIgnored = isSecond(event) && isGone(last.control) && !isNext(event.target);
  if (isIgnored) return stop(event);
  const control = event.target.closest(CONTROLS);
  last = control && { control, kind: kindOf(control), parents: parentsOf(control), x: event.clientX, y: event.clientY, at: event.timeStamp };
}

addEventListener("pointerdown", press, true);
for (const kind of ["keydown", "input"]) addEventListener(kind, () => (last = null), true); // what follows is no double click
for (const kind of ["mousedown", "click", "dblclick"]) addEventListener(kind, (event) => isIgnored && event.detail > 0 && stop(event), true);
