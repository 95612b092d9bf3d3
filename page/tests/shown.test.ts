import { render } from "svelte/server";
import { describe, expect, it } from "vitest";
import type { Next as NextModel, TouchState } from "../src/api/types";
import Next from "../src/parts/Next.svelte";
import Pieces from "../src/widgets/Pieces.svelte";
import { plain, withU } from "../src/widgets/values";

/** What somebody reads, without the marks between. */
const read = (body: string) =>
	body
		.replace(/<!--.*?-->/g, "")
		.replace(/<[^>]*>/g, " ")
		.replace(/\s+/g, " ")
		.trim();
const STATE = { kind: "touch", artefact: "bar", features: ["A", "B"] } as unknown as TouchState;
const NEXT = {
	sentences: [
		{
			text: "Next, put it at x 120, y -45, z 310 mm, rising 20°, towards 90°:",
			values: { x: "120", y: "-45", z: "310" },
		},
		{ text: "  touch B, elbow left, probe from above" },
	],
	feature: "B",
	here: false,
	lies: "rising",
	slope_deg: 19.6,
	azimuth_deg: 90.2,
	elbow: "left",
	comes_from: "above",
} as unknown as NextModel;

describe("what to do next", () => {
	it("is said whole, with the command's numbers", () => {
		expect(read(render(Next, { props: { state: STATE, next: NEXT } }).body)).toBe(
			"Put bar at x 120, y -45, z 310 mm rising 20° , towards 90° Touch 2 of 2 Touch B elbow to the left, probe from above",
		);
	});
	it("says nothing of a place where the artefact stays", () => {
		const body = render(Next, { props: { state: STATE, next: { ...NEXT, here: true } } }).body;
		expect(read(body)).toBe("Touch 2 of 2 Touch B elbow to the left, probe from above");
	});
});

it("a verdict has its word and its shape beside the colour", () => {
	const { body } = render(Pieces, { props: { pieces: [{ style: "fail", text: "fail" }] } });
	expect(body).toContain("<svg");
	expect(read(body)).toBe("fail");
});

it("markup in a name stays a name", () => {
	const { body } = render(Pieces, {
		props: { pieces: [{ style: "name", text: "<script>alert(1)</script>" }] },
	});
	expect(body).not.toContain("<script>");
});

it("numbers are put together as the server rounded them", () => {
	const value = { text: "812.345", u_text: "0.021", unit: "mm", value: 812.34511, u: 0.0104 };
	expect(withU(value)).toBe("812.345 ± 0.021 mm");
	expect(plain({ ...value, text: "–", value: null })).toBe("–");
	expect(withU({ ...value, u_text: null })).toBe("812.345 mm");
});
