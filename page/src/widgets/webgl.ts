/** Whether the browser can paint in space; asked once. */
let can: boolean | null = null;

export function webgl(): boolean {
	if (can === null) {
		try {
			const context = document.createElement("canvas").getContext("webgl2");
			can = context !== null;
			context?.getExtension("WEBGL_lose_context")?.loseContext();
		} catch {
			can = false;
		}
	}
	return can;
}
