import type { Column } from "./columns";

export interface Line {
	name: string;
	/** As long as `x`; null: a gap. */
	y: readonly (number | null)[];
	/** A colour of `look/tokens.css`. */
	colour: string;
	kind: "line" | "points" | "limit";
}

/** All of it comes from the server: numbers to paint, and the words of the table. */
export interface Chart {
	title: string;
	/** Seconds since 1970 where `time`, else a number of something. */
	x: readonly number[];
	time: boolean;
	xLabel: string;
	yLabel: string;
	lines: readonly Line[];
	columns: readonly Column[];
	table: readonly Record<string, string>[];
	height?: number;
}
