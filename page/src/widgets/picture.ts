/** What is shown of an arm, whoever paints it: in space (`arm3d.ts`) or flat (`ArmFlat.svelte`). */
import type { Bodies, Scene } from "../api/types";
import type { Point3 } from "./geometry";

export interface Picture {
	scene: Scene;
	/** The arm as it is to be held at the next touch. */
	ghost: Bodies | null;
	/** The features of the artefact, where it stands or is to be put. */
	places: readonly Point3[];
	/** The feature to touch next. */
	goal: Point3 | null;
	past: readonly Past[];
}

export interface Past {
	at: Point3;
	kind: "fitted" | "held-out" | "odd";
}

/** Numbers of a frame: twelve for each body, and the tip behind them. */
export type Frames = Float32Array | readonly number[];
/** Calls with each frame that comes, until what it returned is called. */
export type Feed = (listener: (frames: Frames) => void) => () => void;

export function framesOf(bodies: Bodies): number[] {
	return bodies.bodies.flat();
}

/** What is left out of pictures that move. */
export const SHOWN_GROUPS: readonly string[] = ["floor", "arm", "axes"];
