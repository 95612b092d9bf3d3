/** A decimal point or a comma, as people type; null: not a number above zero. */
export function number(text: string): number | null {
	const found = Number(text.trim().replace(",", "."));
	return Number.isFinite(found) && found > 0 ? found : null;
}
