import { describe, expect, it } from "vitest";
import { FRONT, outline, placed, rowAt, seen, TOP } from "../src/widgets/geometry";

describe("geometry", () => {
	it("places a point by a quarter turn about z and a shift", () => {
		const row = [0, -1, 0, 10, 1, 0, 0, 20, 0, 0, 1, 30];
		expect(placed(row, [1, 2, 3])).toEqual([8, 21, 33]);
	});
	it("looks from the top and from the front", () => {
		expect(seen(TOP, [1, 2, 3])).toEqual([1, 2, 3]);
		expect(seen(FRONT, [1, 2, 3])).toEqual([1, 3, -2]);
	});
	it("leaves out what is inside and on the edge", () => {
		const found = outline([
			[0, 0],
			[4, 0],
			[2, 1],
			[4, 4],
			[2, 0],
			[0, 4],
		]);
		expect(found).toEqual([
			[0, 0],
			[4, 0],
			[4, 4],
			[0, 4],
		]);
	});
	it("takes a body out of a frame", () => {
		const numbers = Float32Array.from({ length: 36 }, (_, k) => k);
		expect(rowAt(numbers, 1)).toEqual([12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23]);
	});
});
