/** Something that is asked of the server: while it lasts buttons wait, and a no is shown where it was asked. */
import { announce } from "./announce.svelte";
import { Refusal, SILENT } from "./api/refusal";
import { said } from "./words/said.svelte";
import { t } from "./words/words.svelte";

export class Doing {
	busy = $state(false);
	wrong = $state<string | null>(null);

	/** What it gives, or null where it was refused. */
	async run<T>(work: () => Promise<T>): Promise<T | null> {
		if (this.busy) return null;
		this.busy = true;
		this.wrong = null;
		try {
			return await work();
		} catch (error) {
			this.wrong = inWords(error);
			return null;
		} finally {
			this.busy = false;
		}
	}

	clear = (): void => {
		this.wrong = null;
	};

	/** A sentence of the page itself. */
	refuse(text: string): void {
		this.wrong = text;
		announce(text, true);
	}
}

export function inWords(error: unknown): string {
	if (error instanceof Refusal) return error.status === SILENT ? t("error.silent") : said(error.sentence);
	return t("error.fault", { what: error instanceof Error ? error.message : String(error) });
}
