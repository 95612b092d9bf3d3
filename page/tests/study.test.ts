import { describe, expect, it } from "vitest";
import type { TableSeen } from "../src/api/types";
import { isBad, studyOf } from "../src/widgets/study";

const asked = (answers: Record<string, string>, columns: Record<string, string> = {}) =>
	studyOf(["f"], answers, columns, "chosen");

describe("what is said of a table", () => {
	it("nothing said is nothing asked", () => {
		expect(asked({})).toMatchObject({
			files: ["f"],
			touched: [],
			columns: [],
			one_standing: false,
			skip_bad: false,
		});
		expect(asked({}).arm).toMatchObject({ arm: null, reach_mm: null, counts_per_turn: null });
	});
	it("an artefact has its size, with a comma too", () => {
		expect(asked({ artefact: "bar", length: "443,172", u: "0.001" }).touched).toEqual([
			{ kind: "bar", length_mm: 443.172, u_mm: 0.001 },
		]);
	});
	it("several that a column names have each their own", () => {
		const answers = { artefact: "bar", "artefact@K1": "seat", "artefact@K2": "sphere", "diameter@K2": "25" };
		expect(asked(answers).touched).toEqual([
			{ kind: "seat", name: "K1" },
			{ kind: "sphere", name: "K2", diameter_mm: 25 },
		]);
	});
	it("the arm is the one that is chosen, or a reach, never both", () => {
		const both = { reach: "900" };
		expect(asked({ ...both, drawing: "arm" }).arm).toMatchObject({ arm: "chosen", reach_mm: null });
		expect(asked({ ...both, drawing: "reach" }).arm).toMatchObject({ arm: null, reach_mm: 900 });
	});
	it("one standing is said, or the column that tells them", () => {
		expect(asked({ standing: "one" }).one_standing).toBe(true);
		expect(asked({ standing: "Messung" }).columns).toEqual([{ ours: "placement", theirs: "Messung" }]);
	});
	it("columns that were said by hand, and no empty ones", () => {
		expect(asked({}, { "Achse 1": "q1", Bemerkung: " " }).columns).toEqual([
			{ ours: "q1", theirs: "Achse 1" },
		]);
	});
	it("counts and labels are lists", () => {
		const found = asked({ counts_per_turn: "4096 4096", names: "feature.A=links feature.B=rechts" });
		expect(found.arm?.counts_per_turn).toEqual([4096, 4096]);
		expect(found.labels).toEqual([
			{ column: "feature", ours: "A", theirs: "links" },
			{ column: "feature", ours: "B", theirs: "rechts" },
		]);
	});
});

it("a bad cell is that one, not one whose line begins alike", () => {
	const table = { columns: [{ bad: ["line 12, column 'q1': 'x'"] }] } as unknown as TableSeen;
	expect([isBad(table, 0, "line 12"), isBad(table, 0, "line 1"), isBad(table, 1, "line 12")]).toEqual([
		true,
		false,
		false,
	]);
});
