import { expect, it } from "vitest";
import { number } from "../src/typed";

it("takes a point or a comma, and nothing that is no number above zero", () => {
	expect(["0.04", "0,04", " 500 ", "1e-2"].map(number)).toEqual([0.04, 0.04, 500, 0.01]);
	expect(["", "x", "0", "-1", "1.2.3", "1,000.5", "Infinity"].map(number)).toEqual(Array(7).fill(null));
});
