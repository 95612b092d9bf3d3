import { afterEach, describe, expect, it } from "vitest";
import type { Sentence } from "../src/api/types";
import { learn, said, tongue } from "../src/words/said.svelte";

const REASON: Sentence = {
	text: "moved 0.062 mm while touching: hold still",
	template: "moved {moved} mm while touching: hold still",
	values: { moved: "0.062" },
};
const REFUSED: Sentence = {
	text: "Not taken: moved 0.062 mm while touching: hold still.",
	template: "Not taken: {reason}.",
	values: { reason: REASON },
};

afterEach(() => learn("en"));

describe("what the server says", () => {
	it("is English where nothing else was chosen", () => {
		expect(said(REFUSED)).toBe(REFUSED.text);
		expect(tongue(REFUSED)).toBeUndefined();
	});
	it("is said in German, what stands in it too, with the decimal point", async () => {
		await learn("de");
		expect(said(REFUSED)).toBe("Nicht genommen: beim Antasten um 0.062 mm bewegt: stillhalten.");
		expect(tongue(REFUSED)).toBeUndefined();
	});
	it("is said in Chinese", async () => {
		await learn("zh");
		expect(said(REFUSED)).toBe("未采集：测触时移动了 0.062 mm：请保持静止。");
	});
	it("stays English, and is marked so, where nobody has translated it", async () => {
		await learn("de");
		const unknown = { text: "x 1", template: "x {n}", values: { n: "1" } };
		expect(said(unknown)).toBe("x 1");
		expect(said({ text: "plain" })).toBe("plain");
		expect([tongue(unknown), tongue({ text: "plain" })]).toEqual(["en", "en"]);
		expect(tongue({ text: "", template: "constructor" })).toBe("en");
	});
	it("begins with a capital where it does in English", async () => {
		await learn("de");
		const asks = { text: "what was touched", template: "what was touched", values: {} };
		const asked = { text: "What was touched?", template: "{asks}?", values: { asks } };
		expect(said(asked)).toBe("Was angetastet wurde?");
		expect(said(asks)).toBe("was angetastet wurde");
	});
	it("a value is a value, whatever stands in it", async () => {
		await learn("de");
		const odd = { text: "", template: "Not taken: {reason}.", values: { reason: "{reason} $& {x}" } };
		expect(said(odd)).toBe("Nicht genommen: {reason} $& {x}.");
	});
});
