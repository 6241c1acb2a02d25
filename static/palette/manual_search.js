// Searches the manual, in the index that its own search uses; it is read when the palette is first used.

import { hasManual, listModels } from "../bar/models.js";
import { wordsOf } from "../parts/words.js";
import { signal } from "../vendor/preact.js";

const MAX_RESULTS = 6;
const MIN_LETTERS = 3; // letters of a search
const AROUND = 60; // letters of a text shown before the word found

/** The sections of the manual: {title, page, text, low, address}; null before they have been read. `page` is the title of the page of a
 * section that does not begin one. */
const sections = signal(null);
let asked = false;

/** Reads the index, once. */
export async function readManual() {
  if (asked) return;
  asked = true;
  try {
    if (!hasManual.value) await listModels(); // the manual may have been built since
    asked = hasManual.value;
    if (!asked) return;
    const { docs } = await (await fetch("/manual/search/search_index.json")).json();
    const titles = new Map(docs.map(({ location, title }) => [location, plainText(title)]));
    sections.value = docs.map(({ location, text }) => {
      const [plain, isPart] = [plainText(text), location.includes("#")];
      const page = isPart ? (titles.get(location.split("#")[0]) ?? "") : "";
      return { title: titles.get(location), page, text: plain, low: plain.toLowerCase(), address: `/manual/${location}`, depth: isPart ? 1 : 0 };
    });
  } catch {
    asked = false; // it is asked again when the palette is opened again
  }
}

const SIGNS = { lt: "<", gt: ">", quot: '"', amp: "&" };

/** Returns the text of a piece of HTML, which is shown as text. */
function plainText(markup) {
  const text = markup.replace(/<[^>]*>/g, " ").replace(/&(?:#(\d+)|(lt|gt|quot|amp));/g, (_, code, name) => (name ? SIGNS[name] : String.fromCodePoint(code)));
  return text.replace(/\s+/g, " ").trim();
}

/** Returns the sections that contain all words of a search, the best first: {title, page, text, address}, with a piece of the text around
 * the first word. */
export function inManual(search) {
  const words = wordsOf(search);
  if (sections.value === null || words.join("").length < MIN_LETTERS) return [];
  const found = [];
  for (const section of sections.value) {
    const title = section.title.toLowerCase();
    if (!words.every((word) => title.includes(word) || section.low.includes(word))) continue;
    const score = words.reduce((sum, word) => sum + (title === word ? 30 : title.startsWith(word) ? 12 : title.includes(word) ? 8 : 1), 0) - section.depth;
    found.push({ section, score });
  }
  found.sort((one, other) => other.score - one.score);
  return found.slice(0, MAX_RESULTS).map(({ section: { title, page, text, low, address } }) => {
    const at = Math.max(0, ...words.map((word) => low.indexOf(word)).filter((place) => place >= 0).slice(0, 1));
    const from = at > AROUND ? text.indexOf(" ", at - AROUND) + 1 : 0;
    return { title, page, text: `${from > 0 ? "… " : ""}${text.slice(from, from + 3 * AROUND)}`, address };
  });
}
