import { expect, it } from "vitest";
import { placeOf } from "../src/widgets/touching";

it("takes the numbers out of the command's sentence", () => {
	const said = ["Next, put it at x 120, y -45, z 310 mm, rising 20°, towards 90°:", "  touch B, elbow left"];
	expect(placeOf(said)).toEqual({ x: "120", y: "-45", z: "310" });
	expect(placeOf(["Next, where it stands: touch B, probe from above"])).toBeNull();
});
