/** Keys that mean something on a screen, while nobody writes and no button has the key for itself. */
export type Keys = Record<string, () => void>;

const WRITES = "input, textarea, select, [contenteditable]";
const PRESSES = "button, a, summary, [role=slider]";

/** Whether the key is meant for what has the focus. */
export function takes(target: Element | null, key: string): boolean {
	if (!target) return false;
	if (target.closest("dialog")) return true;
	if (target.closest(WRITES)) return true;
	return (key === " " || key === "Enter") && target.closest(PRESSES) !== null;
}

/** Listens until what is returned is called. */
export function listen(keys: Keys): () => void {
	const pressed = (event: KeyboardEvent) => {
		if (event.ctrlKey || event.metaKey || event.altKey || event.repeat) return;
		const act = keys[event.key] ?? keys[event.key.toLowerCase()];
		if (!act || takes(event.target as Element | null, event.key)) return;
		event.preventDefault();
		act();
	};
	addEventListener("keydown", pressed);
	return () => removeEventListener("keydown", pressed);
}
