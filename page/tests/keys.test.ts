import { expect, it } from "vitest";
import { takes } from "../src/keys";

/** As much of an element as is asked: what it, or something around it, is. */
const element = (...is: string[]) =>
	({
		closest: (asked: string) => (asked.split(", ").some((each) => is.includes(each)) ? {} : null),
	}) as unknown as Element;

it("a key belongs to whoever writes, and the space bar to a button that has the focus", () => {
	expect(takes(null, " ")).toBe(false);
	expect(takes(element("input"), "n")).toBe(true);
	expect(takes(element("button"), " ")).toBe(true);
	expect(takes(element("button"), "n")).toBe(false);
	expect(takes(element("dialog"), "q")).toBe(true);
	expect(takes(element("body"), " ")).toBe(false);
});
