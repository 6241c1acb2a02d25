// Counts as text.

/** Returns a count with its noun: «1 chunk», «2 chunks»; `many` is for irregular plurals. */
export function counted(count, one, many = `${one}s`) {
  return `${count.toLocaleString("en")} ${count === 1 ? one : many}`;
}
