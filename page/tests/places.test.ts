import { describe, expect, it } from "vitest";
import { pathOf, placeOf } from "../src/router.svelte";
import { SCREENS } from "../src/screens";
import { tokenOf } from "../src/signin";
import { wished } from "../src/words/words.svelte";

describe("places", () => {
	it("are paths, and what follows is an id", () => {
		expect(placeOf("/")).toMatchObject({ screen: "/", rest: null });
		expect(placeOf("/results/ab12")).toMatchObject({ screen: "/results", rest: "ab12" });
		expect(placeOf("/records/my%20arm%2F2?x=1").rest).toBe("my arm/2");
		expect(placeOf("/records/my%20arm?x=1").query.get("x")).toBe("1");
		expect(placeOf("/records/100%").rest).toBe("100%");
	});
	it("go there and back", () => {
		for (const name of ["plain", "a b", "ü/ö", "50%?"])
			expect(placeOf(pathOf("/records", name)).rest).toBe(name);
	});
	it("are there once each", () => {
		const paths = SCREENS.map((each) => each.path);
		expect(new Set(paths).size).toBe(paths.length);
		expect(SCREENS.filter((each) => each.first).length).toBeLessThanOrEqual(4);
	});
});

it("the token stands behind the #, and nowhere else", () => {
	expect(tokenOf("#token=abc-_1")).toBe("abc-_1");
	expect(tokenOf("")).toBeNull();
	expect(tokenOf("#other=1")).toBeNull();
});

it("speaks the first of a browser's wishes that it knows", () => {
	expect(wished(["fr-FR", "de-AT", "en"])).toBe("de");
	expect(wished(["zh-Hans-CN"])).toBe("zh");
	expect(wished(["fr", "ja"])).toBe("en");
});
