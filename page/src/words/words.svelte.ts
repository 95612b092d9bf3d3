/** What the page says, in the language that somebody chose. Numbers keep the decimal point in all of them. */
import { keep, kept } from "../kept";
import en from "./en.json";
import { learn } from "./said.svelte";

export type WordKey = keyof typeof en;
export type Language = "en" | "de" | "zh";
type Catalogue = Record<WordKey, string>;

export const LANGUAGES: readonly Language[] = ["en", "de", "zh"];
/** Each by its own name. */
export const NAMES: Record<Language, string> = { en: "English", de: "Deutsch", zh: "中文" };
const CATALOGUES: Record<Language, () => Promise<Catalogue>> = {
	en: async () => en,
	de: async () => (await import("./de.json")).default,
	zh: async () => (await import("./zh.json")).default,
};

let spoken = $state<Language>("en");
let catalogue = $state.raw<Catalogue>(en);

/** The language that is spoken now. */
export function language(): Language {
	return spoken;
}

/** Whoever asks a server gets a language that it knows; of a browser's wishes the first that the page speaks. */
export function wished(wishes: readonly string[]): Language {
	for (const wish of wishes) {
		const found = LANGUAGES.find((each) => wish.toLowerCase().split("-")[0] === each);
		if (found) return found;
	}
	return "en";
}

/** What was chosen here before, else what the browser asks for. */
export function firstLanguage(): Language {
	const before = kept("language");
	return LANGUAGES.find((each) => each === before) ?? wished(navigator.languages);
}

/** Speaks it from now on. */
export async function speak(chosen: Language, remember = true): Promise<void> {
	const [words] = await Promise.all([CATALOGUES[chosen](), learn(chosen)]);
	catalogue = words;
	spoken = chosen;
	document.documentElement.lang = chosen;
	if (remember) keep("language", chosen);
}

/** A sentence with its values put in: "{arm} is calibrated". */
export function t(key: WordKey, values: Record<string, string | number> = {}): string {
	return filled(catalogue[key], values);
}

/** The sentence for one, or that for any other count; both may say `{count}`. */
export function counted(
	count: number,
	one: WordKey,
	other: WordKey,
	values: Record<string, string | number> = {},
): string {
	return t(count === 1 ? one : other, { count, ...values });
}

/** What is not given stays in its braces, where a test sees it. */
export function filled(text: string, values: Record<string, string | number>): string {
	return text.replace(/\{(\w+)\}/g, (whole, name: string) => {
		const value = values[name];
		return value === undefined ? whole : String(value);
	});
}

/** A time of the server as people here write it. */
export function when(iso: string, withTime = true): string {
	const style = withTime
		? ({ dateStyle: "medium", timeStyle: "short" } as const)
		: ({ dateStyle: "medium" } as const);
	return new Intl.DateTimeFormat(spoken, style).format(new Date(iso));
}

/** "43 days ago", of a count of days that the server gives. */
export function daysAgo(days: number): string {
	return new Intl.RelativeTimeFormat(spoken, { numeric: "auto" }).format(-days, "day");
}
