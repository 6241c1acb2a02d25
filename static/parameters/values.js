// Formats, parses and checks values of parameters.

/** Returns a value as text for a field. */
export function written(value) {
  return value === null || value === undefined ? "" : String(value);
}

/** What is wrong with a text for which `isTooLarge` is true. */
export const TOO_LARGE = "the number is too large";

/** Whether a text is a number beyond the largest that can be computed with, such as 1e400. */
export function isTooLarge(text) {
  return Math.abs(Number(text)) === Infinity && /\d/.test(text);
}

/** Returns the value of a text: a number, true, false, None (null), or the text itself; what is in quotation marks is always a text.
 * Throws an Error with the reason if the quotation marks are wrong, or a number is too large. */
export function literal(text) {
  if (text.includes('"')) return quoted(text);
  if (isTooLarge(text)) throw new Error(TOO_LARGE);
  if (text !== "" && Number.isFinite(Number(text))) return Number(text);
  const words = { __proto__: null, true: true, false: false, True: true, False: false, None: null };
  return text in words ? words[text] : text;
}

function quoted(text) {
  try {
    return JSON.parse(text);
  } catch {
    throw new Error("the quotation marks are wrong");
  }
}

/** Returns the bounds of a parameter as text: "more than 0, at most 3", "0.3 to 0.7". */
function boundsText({ above, least, below, most }) {
  if (least !== null && most !== null) return `${least} to ${most}`;
  const words = { "more than": above, "at least": least, "less than": below, "at most": most };
  return Object.entries(words).flatMap(([word, bound]) => (bound === null ? [] : `${word} ${bound}`)).join(", ");
}

/** Returns the values that a parameter takes, and its default, as text: "0.3 to 0.7, or empty; default 0.5". */
export function valuesText(parameter) {
  const bounds = boundsText(parameter);
  const values = parameter.optional ? (bounds ? `${bounds}, or empty` : "may be empty") : bounds;
  return [values, parameter.default === null ? "" : `default ${written(parameter.default)}`].filter(Boolean).join("; ");
}

/** Returns the range of a slider for a number with both bounds, {min, max, step}; null for other parameters. */
export function rangeOf({ takes, above, least, below, most }) {
  const [low, high] = [least ?? above, most ?? below];
  if ((takes !== "number" && takes !== "whole number") || low === null || high === null || !(high > low)) return null;
  const fine = 10 ** Math.floor(Math.log10((high - low) / 100));
  const step = takes === "whole number" ? Math.max(1, Math.round(fine)) : fine;
  return { min: least ?? low + step, max: most ?? high - step, step };
}

/** Parses the text of a field: {value}, or {problem} with a description of valid values. */
export function read(parameter, text) {
  const { takes, optional } = parameter;
  if (takes === "switch") return { value: text === "true" };
  if (text === "" && optional) return { value: null };
  if (takes === "choice") return { value: parameter.choices.find((choice) => String(choice) === text) };
  if (takes !== "number" && takes !== "whole number") return { value: text };
  const value = Number(text);
  if (isTooLarge(text)) return { problem: TOO_LARGE };
  const hint = text.includes(",") ? "; the decimal point is '.', and nothing separates thousands" : "";
  if (text.trim() === "" || !Number.isFinite(value)) return { problem: `must be a ${takes}${hint}` };
  if (takes === "whole number" && !Number.isInteger(value)) return { problem: "must be a whole number" };
  const { above, least, below, most } = parameter;
  const held = (above === null || value > above) && (least === null || value >= least) && (below === null || value < below) && (most === null || value <= most);
  return held ? { value } : { problem: `must be ${boundsText(parameter)}` };
}
