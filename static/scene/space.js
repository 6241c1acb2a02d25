// Vectors of three numbers, in the world frame: z points up.

export const plus = (a, b, part = 1) => a.map((x, axis) => x + b[axis] * part);
export const minus = (a, b) => plus(a, b, -1);
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const unit = (a) => a.map((x) => x / (Math.hypot(...a) || 1));
