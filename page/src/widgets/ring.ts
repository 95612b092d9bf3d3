/** Length of the ring's line in its own units. */
export const ROUND = 264;

/** How far the line's beginning is pushed back so that a part of it is seen. */
export function arc(part: number): number {
	const inside = Math.min(1, Math.max(0, Number.isFinite(part) ? part : 0));
	return Math.round(ROUND * (1 - inside));
}
