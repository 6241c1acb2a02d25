// Fuzzy search in short texts: each word of the search is in the text, or its letters are in order in one word of it, or at the starts of
// several; better the nearer together and to starts of words.

import { wordsOf } from "../parts/words.js";

const START = 8; // for a letter at the start of a word
const NEXT = 5; // for a letter right after the one found before
const EARLY = 3; // for a whole word of the search at the start of the text
const MAX_GAP = 3; // the most that a gap between two letters costs

const isStart = (text, at) => at === 0 || /[^\p{L}\p{N}]/u.test(text[at - 1]);

/** Returns {score, places} of the best way to find a word in a text from a place on; null for none. */
function wordIn(word, text) {
  const whole = text.indexOf(word);
  if (whole >= 0) {
    const starts = [whole, ...startsOf(word, text)].find((at) => isStart(text, at)) ?? whole;
    const score = word.length * (START + NEXT) + (isStart(text, starts) ? START : 0) + (starts === 0 ? EARLY : 0);
    return { score, places: Array.from(word, (_, n) => starts + n) };
  }
  const found = [];
  for (let from = 0; from < text.length; from += 1) {
    if (text[from] === word[0] && isStart(text, from)) found.push(inOneWord(word, text, from), inSeveralWords(word, text, from));
  }
  const [best = null] = found.filter(Boolean).toSorted((one, other) => other.score - one.score);
  // Letters here and there are chance.
  return best !== null && best.score >= (word.length - 1) * 2 ? best : null;
}

/** Finds letters in order in the one word of the text that starts at a place. */
function inOneWord(word, text, from) {
  const places = [from];
  let score = START;
  for (const letter of word.slice(1)) {
    const after = places.at(-1) + 1;
    const at = text.indexOf(letter, after);
    if (at < 0 || /[^\p{L}\p{N}]/u.test(text.slice(after, at))) return null;
    score += at === after ? NEXT : -Math.min(MAX_GAP, at - after);
    places.push(at);
  }
  return { score, places };
}

/** Finds letters in order where each follows the one before at once, or starts a later word. */
function inSeveralWords(word, text, from) {
  const places = [from];
  let score = START;
  for (const letter of word.slice(1)) {
    let at = places.at(-1) + 1;
    const isNext = text[at] === letter;
    while (at < text.length && !isNext && !(text[at] === letter && isStart(text, at))) at += 1;
    if (at === text.length) return null;
    score += isNext ? NEXT : START;
    places.push(at);
  }
  return { score, places };
}

function startsOf(word, text) {
  const found = [];
  for (let at = text.indexOf(word); at >= 0; at = text.indexOf(word, at + 1)) found.push(at);
  return found;
}

/** Returns how well a search fits a text: {score, places}, with the places of the letters found; null if it does not. */
export function match(search, text) {
  const low = text.toLowerCase();
  let score = 0;
  const places = new Set();
  for (const word of wordsOf(search)) {
    const found = wordIn(word, low);
    if (found === null) return null;
    score += found.score;
    found.places.forEach((place) => places.add(place));
  }
  return { score: score - text.length / 100, places };
}
