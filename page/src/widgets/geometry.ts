/** Points of bodies onto the screen: nothing here is a result, only where it is painted. */
export type Point3 = readonly [number, number, number];
export type Point2 = readonly [number, number];
/** A body's frame: the upper three rows of its 4 × 4 matrix, row by row, mm. */
export type Row = readonly number[];
/** Two directions of the base frame: what goes to the right on the screen, and what goes up. */
export interface Side {
	right: Point3;
	up: Point3;
	/** Towards the eye. */
	near: Point3;
}

export const TOP: Side = { right: [1, 0, 0], up: [0, 1, 0], near: [0, 0, 1] };
export const FRONT: Side = { right: [1, 0, 0], up: [0, 0, 1], near: [0, -1, 0] };

/** A point of a body's frame in the base frame. */
export function placed(row: Row, [x, y, z]: Point3): Point3 {
	const m = (k: number) => row[k] ?? 0;
	return [
		m(0) * x + m(1) * y + m(2) * z + m(3),
		m(4) * x + m(5) * y + m(6) * z + m(7),
		m(8) * x + m(9) * y + m(10) * z + m(11),
	];
}

function dot(a: Point3, b: Point3): number {
	return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** To the right and up, mm, and how near. */
export function seen(side: Side, point: Point3): Point3 {
	return [dot(side.right, point), dot(side.up, point), dot(side.near, point)];
}

/** The outline of points, counter-clockwise (Andrew 1979, Inf. Proc. Lett. 9, 216). */
export function outline(points: readonly Point2[]): Point2[] {
	const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
	if (sorted.length < 3) return sorted;
	const half = (all: readonly Point2[]) => {
		const chain: Point2[] = [];
		for (const point of all) {
			for (
				let last = chain.at(-1), before = chain.at(-2);
				last && before;
				last = chain.at(-1), before = chain.at(-2)
			) {
				const left =
					(last[0] - before[0]) * (point[1] - before[1]) - (last[1] - before[1]) * (point[0] - before[0]);
				if (left > 0) break;
				chain.pop();
			}
			chain.push(point);
		}
		chain.pop();
		return chain;
	};
	return [...half(sorted), ...half(sorted.reverse())];
}

/** One of several bodies out of the numbers of a frame. */
export function rowAt(numbers: Float32Array | readonly number[], body: number): Row {
	return Array.from(numbers.slice(12 * body, 12 * body + 12));
}
