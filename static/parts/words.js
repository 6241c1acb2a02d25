// Searches of several words.

/** Returns the words of a search in lower case. */
export const wordsOf = (search) => search.toLowerCase().split(/\s+/).filter(Boolean);
