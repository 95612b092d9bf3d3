/** Light or dark: as somebody chose here, else as the system has it. */
import { keep, kept } from "./kept";

export type Look = "system" | "light" | "dark";
export const LOOKS: readonly Look[] = ["system", "light", "dark"];

const wished = LOOKS.find((each) => each === kept("look"));
let chosen = $state<Look>(wished ?? "system");
let shown = $state<"light" | "dark">("light");

export function look(): Look {
	return chosen;
}

/** What is seen now: pictures that are painted look it up. */
export function seen(): "light" | "dark" {
	return shown;
}

export function choose(next: Look): void {
	chosen = next;
	keep("look", next);
	apply();
}

/** Once, and whenever the system changes its mind. */
export function begin(): void {
	matchMedia("(prefers-color-scheme: dark)").addEventListener("change", apply);
	apply();
}

function apply(): void {
	const system = matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
	shown = chosen === "system" ? system : chosen;
	document.documentElement.dataset.look = shown;
}

/** A colour of `look/tokens.css` as it is now. */
export function colour(name: string): string {
	return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}
