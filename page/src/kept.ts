/** What this browser remembers of somebody's choices; nothing where it must not. */
const PREFIX = "ulna.";

export function kept(name: string): string | null {
	try {
		return localStorage.getItem(PREFIX + name);
	} catch {
		return null;
	}
}

export function keep(name: string, value: string): void {
	try {
		localStorage.setItem(PREFIX + name, value);
	} catch {
		// a browser that keeps nothing asks again next time
	}
}
