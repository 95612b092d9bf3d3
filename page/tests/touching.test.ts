import { expect, it } from "vitest";
import { placeOf } from "../src/widgets/touching";

it("takes the numbers out of the server's sentence", () => {
	const at = { x: "120", y: "-45", z: "310" };
	const put = { text: "Next, put it at x 120, y -45, z 310 mm:", template: "Next, put it at …", values: at };
	expect(placeOf([put, { text: "  touch B, elbow left" }])).toEqual(at);
	expect(placeOf([{ text: "Next, where it stands: touch B, probe from above" }])).toBeNull();
});
