/** Numbers as the server rounded them: put together, never worked with. */
import type { Value } from "../api/types";

/** "71 µm" */
export function plain(value: Value): string {
	return value.unit && value.value !== null ? `${value.text} ${value.unit}` : value.text;
}

/** "812.345 ± 0.021 mm" */
export function withU(value: Value): string {
	if (value.value === null || value.u_text === null) return plain(value);
	return `${value.text} ± ${value.u_text}${value.unit ? ` ${value.unit}` : ""}`;
}
