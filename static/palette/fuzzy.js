// Fuzzy search in short texts: the letters of each word of the search occur in order; better the nearer together and to starts of words.

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
  let best = null;
  for (let from = text.indexOf(word[0]); from >= 0; from = text.indexOf(word[0], from + 1)) {
    const places = [from];
    let score = isStart(text, from) ? START : 0;
    for (const letter of word.slice(1)) {
      const after = places.at(-1) + 1;
      let at = text.indexOf(letter, after);
      // Rather the start of a later word than the middle of this one.
      for (let later = at; later >= 0 && at !== after; later = text.indexOf(letter, later + 1)) {
        if (isStart(text, later)) {
          at = later;
          break;
        }
      }
      if (at < 0) return best;
      score += at === after ? NEXT : isStart(text, at) ? START : -Math.min(MAX_GAP, at - after);
      places.push(at);
    }
    if (best === null || score > best.score) best = { score, places };
  }
  // Letters here and there are chance.
  return best !== null && best.score >= (word.length - 1) * 2 ? best : null;
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
  for (const word of search.toLowerCase().split(/\s+/).filter(Boolean)) {
    const found = wordIn(word, low);
    if (found === null) return null;
    score += found.score;
    found.places.forEach((place) => places.add(place));
  }
  return { score: score - text.length / 100, places };
}
