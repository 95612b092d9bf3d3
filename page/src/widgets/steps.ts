/** Steps of a check or a test in the words of the page; every number is the server's. */
import type { CheckState, TestState } from "../api/types";
import { t } from "../words/words.svelte";
import { plain } from "./values";

export type StepsState = CheckState | TestState;
export type StepNow = NonNullable<StepsState["present"]>;
export type Part = StepsState["parts"][number];
type Label = "position" | "orientation" | "repeat";
export type FigureNow = Part["figures"][number];

interface Said {
	/** What to do. */
	what: string;
	how: string;
}
/** By the kind of a test; of one that the page does not know the list's own words are shown. */
const DO: Record<string, (step: StepNow) => Said> = {
	"single-point": () => ({ what: t("steps.seat"), how: t("steps.seat.how") }),
	length: (step) => ({ what: t("steps.end", { end: step.feature }), how: "" }),
	volumetric: (step) => ({ what: t("steps.end", { end: step.feature }), how: "" }),
	sphere: () => ({ what: t("steps.ball"), how: t("steps.ball.how") }),
	"effective-diameter": () => ({ what: t("steps.ball"), how: t("steps.ball.how") }),
	articulation: (step) => ({
		what: t("steps.turned", { orientation: step.orientation }),
		how: t("steps.ball.how"),
	}),
};

export function toDo(step: StepNow): Said | null {
	return DO[step.kind]?.(step) ?? null;
}

/** "bar · place 2 · measurement 1": which measurement; the last where there are several of one. */
export function measurementOf(state: StepsState, part: Pick<Part, "test" | "artefact" | Label>): string {
	const again = state.parts.some((each) => each.test === part.test && each.repeat !== part.repeat);
	return [
		part.artefact || part.test,
		part.position && t("steps.place", { place: part.position }),
		part.orientation && t("steps.orientation", { orientation: part.orientation }),
		again && part.repeat && t("steps.repeat", { repeat: part.repeat }),
	]
		.filter((each) => each)
		.join(" · ");
}

/** "limit 0.060 mm, guard band 3.3 µm" */
export function limitOf(figure: FigureNow): string {
	if (!figure.limit) return "";
	const said = [t("steps.limit", { limit: plain(figure.limit) })];
	if (figure.guard?.value) said.push(t("steps.guard", { guard: plain(figure.guard) }));
	return said.join(", ");
}

/** "Touch 33, step 33: bar 2, spread 4.2 µm · scatter in its seat 5.1 µm" */
export function lastLine(state: StepsState): string {
	const last = state.touches.findLast((each) => each.withdrawn === null);
	if (!last) return "";
	const what = [last.place, last.feature].filter((each) => each).join(" ");
	const values = { number: last.number, step: last.step, what, spread: plain(last.spread) };
	const scatter = last.scatter ? ` · ${t("steps.scatter", { scatter: plain(last.scatter) })}` : "";
	return t("steps.taken", values) + scatter;
}
