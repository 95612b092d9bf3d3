/** What is said aloud to whoever does not see the page: touches and refusals, never what changes sixty times a second. */
let polite = $state("");
let urgent = $state("");

export function announced(): { polite: string; urgent: string } {
	return { polite, urgent };
}

/** The same sentence twice is said twice: a space that nobody hears makes it another. */
export function announce(text: string, now = false): void {
	if (now) urgent = urgent === text ? `${text}\u00a0` : text;
	else polite = polite === text ? `${text}\u00a0` : text;
}
