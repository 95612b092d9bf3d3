/** What the server says, in the language that somebody chose: it sends each sentence in English, with its template. */
import type { Sentence } from "../api/types";
import type { Language } from "./words.svelte";

/** By the English template. */
type Sayings = Record<string, string>;

const SAYINGS: Record<Language, () => Promise<Sayings>> = {
	en: async () => ({}),
	de: async () => (await import("./said.de.json")).default,
	zh: async () => (await import("./said.zh.json")).default,
};

let sayings = $state.raw<Sayings>({});
let english = $state(true);

/** Says what the server says in it from now on. */
export async function learn(language: Language): Promise<void> {
	sayings = await SAYINGS[language]();
	english = language === "en";
}

/** A sentence of the server; one that nobody has translated as it came, in English. */
export function said(sentence: Sentence): string {
	const text = known(sentence);
	if (text === undefined) return sentence.text;
	const values = sentence.values ?? {};
	const whole = text.replace(/\{(\w+)\}/g, (hole, name: string) => {
		const value = values[name];
		if (value === undefined) return hole;
		return typeof value === "string" ? value : said(value);
	});
	// what begins with a clause begins with a capital where it does in English
	const begins = text.startsWith("{") && /^\p{Lu}/u.test(sentence.text);
	return begins ? `${whole.charAt(0).toUpperCase()}${whole.slice(1)}` : whole;
}

/** Of text that is in English on a page in another language; undefined: it is in the page's. */
export function tongue(sentence: Sentence): "en" | undefined {
	return english || known(sentence) !== undefined ? undefined : "en";
}

function known({ template }: Sentence): string | undefined {
	return template && Object.hasOwn(sayings, template) ? sayings[template] : undefined;
}
