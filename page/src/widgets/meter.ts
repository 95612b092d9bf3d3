/** How the meter is laid out: only where things are painted. */
import type { Known, Meter } from "../api/types";
import { plain } from "./values";

export interface Parts {
	known: number;
	all: number;
	length: string;
	u: string;
	goal: string | null;
	more: number | null;
	fresh: { now: number; places: number } | null;
	/** Of the bar, %. */
	share: number;
}

export function meterParts(meter: Meter): Parts {
	const known = Math.min(meter.determined, meter.determinable);
	return {
		known,
		all: meter.determinable,
		length: `${meter.length_mm} mm`,
		u: plain(meter.u_length),
		goal: meter.goal === null ? null : plain(meter.goal),
		more: meter.touches_more,
		fresh:
			meter.fresh_done === null || meter.fresh_places === null
				? null
				: { now: Math.min(meter.fresh_done + 1, meter.fresh_places), places: meter.fresh_places },
		share: meter.determinable ? (100 * known) / meter.determinable : 0,
	};
}

export interface Group {
	unit: string;
	rows: Known[];
	/** Of the scale: logarithms to base 10. */
	low: number;
	high: number;
}

/** Rows of one unit share a scale: mm beside mm. */
export function groups(parameters: readonly Known[]): Group[] {
	const found = new Map<string, Known[]>();
	for (const each of parameters) found.set(each.u.unit, [...(found.get(each.u.unit) ?? []), each]);
	return [...found].map(([unit, rows]) => {
		const logs = rows
			.flatMap((row) => [row.u.value, row.drawn.value])
			.filter((each): each is number => each !== null && each > 0)
			.map(Math.log10);
		const low = logs.length ? Math.floor(Math.min(...logs)) : 0;
		const high = logs.length ? Math.max(Math.ceil(Math.max(...logs)), low + 1) : 1;
		return { unit, rows, low, high };
	});
}

/** Where a value is on the scale, %. */
export function place(value: number, { low, high }: Pick<Group, "low" | "high">): number {
	if (value <= 0) return 0;
	return Math.min(100, Math.max(0, (100 * (Math.log10(value) - low)) / (high - low)));
}
