/** What somebody said of a table, put together as the server asks for it. Nothing is guessed here. */
import type { StudyAsked, TableSeen } from "../api/types";
import { number } from "../typed";

/** Field of a question → what was said; of one of several artefacts "field@name". */
export type Answers = Readonly<Record<string, string>>;

type Touched = NonNullable<StudyAsked["touched"]>[number];

function touched(answers: Answers, name: string | null): Touched | null {
	const of = (field: string) => answers[name === null ? field : `${field}@${name}`]?.trim() ?? "";
	const kind = of("artefact");
	if (!kind) return null;
	return {
		kind,
		...(name === null ? {} : { name }),
		...(of("length") ? { length_mm: number(of("length")) } : {}),
		...(of("diameter") ? { diameter_mm: number(of("diameter")) } : {}),
		...(of("u") ? { u_mm: number(of("u")) } : {}),
	};
}

/** Words between spaces or commas. */
const words = (text: string) => text.split(/[\s,]+/).filter((each) => each);

/** files: by their hashes; columns: the file's name → Ulna's; arm: the one that is chosen on the desk. */
export function studyOf(
	files: readonly string[],
	answers: Answers,
	columns: Readonly<Record<string, string>>,
	arm: string | null,
): StudyAsked {
	const said = (field: string) => answers[field]?.trim() || null;
	const names = Object.keys(answers).flatMap((key) => (key.startsWith("artefact@") ? [key.slice(9)] : []));
	const own = names.length ? names.map((name) => touched(answers, name)) : [touched(answers, null)];
	const standing = said("standing");
	const mapped = Object.entries(columns).filter(([, ours]) => ours.trim());
	const counts = words(said("counts_per_turn") ?? "").map(number);
	return {
		files: [...files],
		touched: own.filter((each) => each !== null),
		arm: {
			arm: said("drawing") === "arm" ? arm : null,
			reach_mm: said("drawing") === "reach" ? number(said("reach") ?? "") : null,
			dh: said("drawing") === "dh" ? said("dh") : null,
			urdf: said("drawing") === "urdf" ? said("urdf") : null,
			convention: said("convention") as "dh" | null,
			angle_unit: said("angle_unit") as "deg" | null,
			parallel: said("parallel") ? words(said("parallel") ?? "") : null,
			zeros: said("zeros") as "known" | null,
			signs: said("signs") as "known" | null,
			counts_per_turn: counts.length ? counts.filter((each) => each !== null) : null,
			ball_mm: number(said("ball") ?? ""),
			tip_link: said("tip_link"),
			base_link: said("base_link"),
		},
		layout: {
			sheet: said("sheet"),
			separator: said("separator"),
			decimal: said("decimal"),
			header: number(said("header") ?? ""),
		},
		columns: [
			...mapped.map(([theirs, ours]) => ({ ours: ours.trim(), theirs })),
			...(standing && standing !== "one" ? [{ ours: "placement", theirs: standing }] : []),
		],
		labels: words(said("names") ?? "").flatMap((each) => {
			const found = /^(\w+)\.(\w+)=(.+)$/.exec(each);
			return found?.[1] && found[2] && found[3]
				? [{ column: found[1], ours: found[2], theirs: found[3] }]
				: [];
		}),
		angle: said("angle") as "deg" | null,
		length_unit: said("length_unit") as "mm" | null,
		one_standing: standing === "one",
		skip_bad: said("skip_bad") === "yes",
	};
}

/** Whether a cell is one of those in which no number stands: the server says which, in the file's own words. */
export function isBad(table: TableSeen, column: number, at: string): boolean {
	return (table.columns[column]?.bad ?? []).some(
		(each) => each === at || each.startsWith(`${at},`) || each.startsWith(`${at}:`),
	);
}
