import { describe, expect, it } from "vitest";
import { reduced, SAID } from "../src/api/reduce";
import type { Activity, LiveEvent, Meter, Touch, TouchState } from "../src/api/types";

const value = { text: "4.1", u_text: null, unit: "µm", value: 0.0041, u: null };
const touch = (number: number, over: Partial<Touch> = {}): Touch => ({
	number,
	feature: "A",
	place: "1",
	held_out: false,
	withdrawn: null,
	tip_mm: [1, 2, 3],
	spread: value,
	off: null,
	times: null,
	suspicious: false,
	...over,
});
const METER: Meter = {
	line: { text: "" },
	touches: 1,
	determined: 1,
	determinable: 25,
	length_mm: 500,
	u_length: value,
	goal: null,
	reached: false,
	touches_more: null,
	fresh_done: null,
	fresh_places: null,
	lacking: [],
	parameters: [],
};
const STATE: TouchState = {
	kind: "touch",
	artefact: "bar",
	features: ["A", "B"],
	by: "still",
	place: 1,
	held_out: false,
	touches: [],
	meter: null,
	next: null,
	why_no_fit: null,
};
const ACTIVITY: Activity = {
	id: "x",
	who: "Ann",
	kind: "touch",
	arm: null,
	virtual: true,
	running: true,
	begun: "2026-11-30T16:00:00+00:00",
	stream: {
		scheme: "virtual",
		device: { text: "virtual arm" },
		channels: ["q1"],
		rate_hz: 500,
		silent_s: 0,
		samples: 1,
		faults: {},
		doubtful: false,
		ended: null,
	},
	state: STATE,
	said: [],
	left: [],
};
const told = (...events: LiveEvent[]) => events.reduce<Activity | null>(reduced, ACTIVITY);
const stateOf = (activity: Activity | null) => activity?.state as TouchState;

describe("events", () => {
	it("a touch comes behind the others, once, and its sentences are kept", () => {
		const event = (one: Touch): LiveEvent => ({
			event: "touch",
			touch: one,
			sentences: [{ text: "Touch." }, { text: `Odd ${one.number}.` }],
		});
		const found = told(event(touch(1)), event(touch(2)), event(touch(2, { suspicious: true })));
		expect(stateOf(found).touches.map((each) => [each.number, each.suspicious])).toEqual([
			[1, false],
			[2, true],
		]);
		expect(found?.said).toEqual(["Odd 1.", "Odd 2.", "Odd 2."].map((text) => ({ text })));
	});
	it("what is known is the newest", () => {
		const found = told({ event: "known", meter: METER, next: null });
		expect(stateOf(found).meter).toBe(METER);
	});
	it("only so many sentences stay", () => {
		const events = Array.from(
			{ length: SAID + 3 },
			(_, k): LiveEvent => ({ event: "said", sentence: { text: `${k}` } }),
		);
		expect(told(...events)?.said).toEqual(["3", "4", "5", "6", "7", "8"].map((text) => ({ text })));
	});
	it("a hello brings the whole activity, and an end its last state", () => {
		const other = { ...ACTIVITY, id: "y" };
		expect(told({ event: "hello", version: "1", contract: "c", activity: other })?.id).toBe("y");
		expect(told({ event: "ended", activity: { ...ACTIVITY, running: false } })?.running).toBe(false);
	});
	it("nothing happens to an activity that nobody looks at", () => {
		expect(reduced(null, { event: "said", sentence: { text: "x" } })).toBeNull();
		expect(reduced(null, { event: "touch", touch: touch(1), sentences: [] })).toBeNull();
	});
	it("where the tip is belongs to a read-out alone", () => {
		const tip = { values: [], why_not: null, distance: null, to: null, still: true, warnings: [] };
		expect(told({ event: "tip", tip })?.state).toBe(STATE);
	});
});
