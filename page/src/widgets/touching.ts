/** What is to be touched next, in the words of the page; every number is the server's. */
import type { Next, Sentence, Touch, TouchState } from "../api/types";
import { t, type WordKey } from "../words/words.svelte";
import { plain } from "./values";

/** Clockwise, seen along the line from the shoulder to the tip. */
export const ELBOWS: Record<string, WordKey> = {
	up: "elbow.up",
	"up-right": "elbow.up-right",
	right: "elbow.right",
	"down-right": "elbow.down-right",
	down: "elbow.down",
	"down-left": "elbow.down-left",
	left: "elbow.left",
	"up-left": "elbow.up-left",
};
export const FROM: Record<string, WordKey> = {
	above: "from.above",
	below: "from.below",
	left: "from.left",
	right: "from.right",
	near: "from.near",
	far: "from.far",
};
export const LIES: Record<string, WordKey> = {
	level: "lies.level",
	rising: "lies.rising",
	falling: "lies.falling",
	upright: "lies.upright",
	hanging: "lies.hanging",
	nowhere: "lies.nowhere",
};

/** "120", "-45", "310" of "Next, put it at x 120, y -45, z 310 mm, level, towards 90°:". */
export function placeOf(sentences: readonly Sentence[]): { x: string; y: string; z: string } | null {
	for (const { values } of sentences) {
		const { x, y, z } = values ?? {};
		if (typeof x === "string" && typeof y === "string" && typeof z === "string") return { x, y, z };
	}
	return null;
}

/** Which of the artefact's features it is, from 1; null where there is only one. */
export function featureOf(state: TouchState, next: Next): { now: number; all: number } | null {
	const index = state.features.indexOf(next.feature);
	return index < 0 || state.features.length < 2 ? null : { now: index + 1, all: state.features.length };
}

/** "Touch 33, A in place 3: spread 4.2 µm." */
export function touchLine(touch: Touch): string {
	const values = {
		number: touch.number,
		feature: touch.feature,
		place: touch.place,
		spread: plain(touch.spread),
	};
	return t(touch.feature ? "touch.taken" : "touch.taken-plain", values);
}
