// Counts as one reads them.

/** Says how many there are of something: «1 chunk», «2 chunks»; `many` where the plural has no mere s. */
export function counted(count, one, many = `${one}s`) {
  return `${count.toLocaleString("en")} ${count === 1 ? one : many}`;
}
