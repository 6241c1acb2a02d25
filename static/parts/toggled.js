// Lists of what is chosen.

/** Returns a list without a thing if it has it, otherwise with it at its end. */
export const toggled = (list, one) => (list.includes(one) ? list.filter((other) => other !== one) : [...list, one]);
