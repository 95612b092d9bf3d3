import { describe, expect, it } from "vitest";
import type { Known, Meter, Value } from "../src/api/types";
import { groups, meterParts, place } from "../src/widgets/meter";

const value = (number: number | null, unit: string): Value => ({
	text: number === null ? "–" : String(number),
	u_text: null,
	unit,
	value: number,
	u: number,
});
const known = (name: string, u: number | null, drawn: number | null, unit: string): Known => ({
	name,
	words: name,
	u: value(u, unit),
	drawn: value(drawn, unit),
	determined: u !== null,
});
const METER: Meter = {
	line: { text: "" },
	touches: 12,
	determined: 27,
	determinable: 25,
	length_mm: 500,
	u_length: value(71, "µm"),
	goal: value(40, "µm"),
	reached: false,
	touches_more: 18,
	fresh_done: null,
	fresh_places: null,
	lacking: [],
	parameters: [],
};

describe("meter", () => {
	it("says what the command says", () => {
		expect(meterParts(METER)).toEqual({
			known: 25,
			all: 25,
			length: "500 mm",
			u: "71 µm",
			goal: "40 µm",
			more: 18,
			fresh: null,
			share: 100,
		});
	});
	it("counts fresh places from one, and not beyond the last", () => {
		expect(meterParts({ ...METER, fresh_done: 2, fresh_places: 10 }).fresh).toEqual({ now: 3, places: 10 });
		expect(meterParts({ ...METER, fresh_done: 10, fresh_places: 10 }).fresh).toEqual({ now: 10, places: 10 });
	});
	it("gives each unit a scale of whole decades", () => {
		const [lengths, angles] = groups([
			known("a", 0.02, 0.5, "mm"),
			known("d", 0.003, 0.5, "mm"),
			known("t", null, 90, "µrad"),
		]);
		expect(lengths).toMatchObject({ unit: "mm", low: -3 });
		expect(angles).toMatchObject({ unit: "µrad", low: 1, high: 2 });
	});
	it("places a value between the decades, and never outside", () => {
		expect(place(0.01, { low: -3, high: -1 })).toBe(50);
		expect(place(1, { low: -3, high: -1 })).toBe(100);
		expect(place(0, { low: -3, high: -1 })).toBe(0);
	});
});
