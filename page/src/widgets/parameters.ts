/** Parameters in words: as docs/concepts/model.md calls them. */
import type { Known } from "../api/types";
import { t, type WordKey } from "../words/words.svelte";

const OF_JOINTS: Record<string, WordKey> = {
	theta0: "parameter.theta0",
	alpha: "parameter.alpha",
	a: "parameter.a",
	d: "parameter.d",
	beta: "parameter.beta",
};

/** "zero of joint 6", of "joint.6.theta0"; what has no word here is said as the server says it. */
export function parameterWords({ name, words }: Pick<Known, "name" | "words">): string {
	const [what, of, key] = name.split(".");
	const word = key === undefined ? undefined : OF_JOINTS[key];
	if (what === "joint" && of && word) return t(word, { joint: of });
	if (what === "probe" && of && key) return t("parameter.probe", { key, probe: of });
	return words;
}
